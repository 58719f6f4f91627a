// Files that a rock may come from: a picture of its minerals, a list of them, traces of joints.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "feldspar/model/heterogeneity_spec.hpp"

namespace feldspar {

/// A PNG picture as phases: by colour, or by value of a grey picture. Black, or the value 0, that no phase has is nothing.
/// @param contents  of the file  @throws InputError  no PNG; a colour outside the legend, with its place
std::shared_ptr<const PhaseMap> read_phase_map(const std::string& contents, const std::filesystem::path& file,
                                               const std::vector<Mineral>& phases);

/// A phase a line, by name; empty lines and what follows a '#' count for nothing. @throws InputError  a name that is no phase
std::vector<int> read_phase_list(const std::string& contents, const std::filesystem::path& file,
                                 const std::vector<Mineral>& phases);

/// Traces of a file.
struct TraceFile {
    std::vector<std::vector<Vec2>> lines_m;
    std::vector<std::string> remarks;  ///< what was left out, and why
};

/// CSV: a head line that names x1, y1, x2, y2 and perhaps set; lengths in m, or in `unit`.
/// DXF: LINE, LWPOLYLINE, POLYLINE; lengths in the unit of $INSUNITS, or in `unit`. Arcs of polylines are refused.
/// @param layer  empty: all  @throws InputError  with the line at which the file is not as it must be
TraceFile read_traces(const std::string& contents, const std::filesystem::path& file, const std::string& unit,
                      const std::string& layer);

}  // namespace feldspar
