// The fields of a test for programs that draw them, as an archive holds them.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "feldspar/methods/result.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

/// A column of the acoustic events.
struct EventValues {
    std::string name;  ///< as in event_columns.hpp, with its unit
    std::vector<double> values;
};

struct TestFields {
    std::string stem;                           ///< of the test's files
    std::vector<Vec2> nodes;                    ///< m, undeformed
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise; grains share no nodes
    std::vector<int> grain;                     ///< of each triangle
    std::vector<int> mineral;                   ///< of each grain; empty for a rock of one mineral
    std::vector<ContactPlace> contacts;         ///< between grains, before the test; empty in archives of earlier versions
    std::vector<Crack> cracks;
    std::vector<EventValues> events;  ///< columns; empty without events
    std::vector<Snapshot> snapshots;
};

/// With the digits of an archive.
TestFields fields_of(const TestResult& result);

/// Reads what write_hdf5() has written. May be called on any thread. @throws InputError if the file cannot be read, is no archive
/// of a test, or one of a later version
TestFields read_archive(const std::filesystem::path& file);

/// Files for ParaView in a directory: `<stem>.pvd`, which lists a time for each snapshot, `<stem>/snapshot-<n>.vtm`, which names
/// its blocks (grains, grain_edges, contacts, cracks, events), their grids
/// `<stem>/<block>-<n>.vtu`, and `<stem>.py`, by which ParaView opens them coloured. Positions are undeformed; `displacement_m`
/// moves them. Files of an earlier export are replaced.
/// @param threads  snapshots that are compressed side by side. @throws OutputError
void write_paraview(const RunDirectory& directory, const TestFields& fields, int threads = 1);

}  // namespace feldspar
