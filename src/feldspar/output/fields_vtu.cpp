// Fields for ParaView: a .pvd that lists, for each snapshot, one grid of triangles (part 0) and one of crack lines (part 1).
// Positions are undeformed; "Warp By Vector" with displacement_m shows the deformed body and the open cracks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/output/crack_geometry.hpp"
#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"
#include "feldspar/output/vtu_grid.hpp"

namespace feldspar {

namespace {

/// The largest and smallest principal stress of each triangle, compression positive: sigma_1 >= sigma_3.
struct PrincipalStresses {
    std::vector<float> sigma_1_MPa, sigma_3_MPa, mean_MPa;
};

PrincipalStresses principal_stresses(const Snapshot& snapshot) {
    PrincipalStresses principal;
    for (std::size_t t = 0; t < snapshot.stress_xx_Pa.size(); ++t) {
        const double mean = 0.5 * (snapshot.stress_xx_Pa[t] + snapshot.stress_yy_Pa[t]);
        const double radius = std::hypot(0.5 * (snapshot.stress_xx_Pa[t] - snapshot.stress_yy_Pa[t]), snapshot.stress_xy_Pa[t]);
        principal.sigma_1_MPa.push_back(static_cast<float>((mean + radius) * MPa));
        principal.sigma_3_MPa.push_back(static_cast<float>((mean - radius) * MPa));
        principal.mean_MPa.push_back(static_cast<float>(mean * MPa));
    }
    return principal;
}

std::vector<float> floats_in_MPa(const std::vector<double>& values_Pa) {
    std::vector<float> values;
    values.reserve(values_Pa.size());
    for (const double value : values_Pa) values.push_back(static_cast<float>(value * MPa));
    return values;
}

/// What the grids of all snapshots have in common.
VtuGrid undeformed_grains(const GrainMesh& mesh, const std::vector<int>& phase_of_grain) {
    std::vector<double> points;
    for (const Vec2 node : mesh.nodes) points.insert(points.end(), {node.x, node.y, 0.0});
    std::vector<std::int32_t> corners;
    for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    std::vector<std::int32_t> grain(mesh.triangles.size());
    for (std::size_t g = 0; g + 1 < mesh.triangle_begin.size(); ++g) {
        for (int t = mesh.triangle_begin[g]; t < mesh.triangle_begin[g + 1]; ++t)
            grain[static_cast<std::size_t>(t)] = static_cast<int>(g);
    }
    VtuGrid grid(points, corners, VtkCell::triangle);
    grid.cell_data("grain", std::span<const std::int32_t>(grain));
    if (!phase_of_grain.empty()) {
        std::vector<std::int32_t> mineral;
        for (const std::int32_t g : grain) mineral.push_back(phase_of_grain[static_cast<std::size_t>(g)]);
        grid.cell_data("mineral", std::span<const std::int32_t>(mineral));
    }
    return grid;
}

std::string grains_vtu(VtuGrid grid, const Snapshot& snapshot, const std::string& comment) {
    std::vector<float> displacement;
    for (const Vec2 u : snapshot.displacement_m)
        displacement.insert(displacement.end(), {static_cast<float>(u.x), static_cast<float>(u.y), 0.0F});
    const PrincipalStresses principal = principal_stresses(snapshot);
    grid.point_data("displacement_m", displacement, 3);
    grid.cell_data("damage", std::span<const float>(snapshot.damage));
    grid.cell_data("stress_xx_MPa", floats_in_MPa(snapshot.stress_xx_Pa));
    grid.cell_data("stress_yy_MPa", floats_in_MPa(snapshot.stress_yy_Pa));
    grid.cell_data("stress_xy_MPa", floats_in_MPa(snapshot.stress_xy_Pa));
    grid.cell_data("sigma_1_MPa", principal.sigma_1_MPa);
    grid.cell_data("sigma_3_MPa", principal.sigma_3_MPa);
    grid.cell_data("mean_stress_MPa", principal.mean_MPa);
    return grid.file(comment);
}

std::string cracks_vtu(const TestResult& result, const std::vector<CrackFaces>& faces, const Snapshot& snapshot,
                       const std::string& comment) {
    std::vector<double> points;
    std::vector<std::int32_t> ends;
    std::vector<float> displacement, time, stress, opening, energy;
    std::vector<std::int32_t> mode;
    std::vector<std::int64_t> step;
    const auto count = std::min(result.cracks.size(), static_cast<std::size_t>(std::max(snapshot.cracks, 0)));
    for (std::size_t c = 0; c < count; ++c) {
        const Crack& crack = result.cracks[c];
        points.insert(points.end(), {crack.from.x, crack.from.y, 0.0, crack.to.x, crack.to.y, 0.0});
        ends.insert(ends.end(), {static_cast<std::int32_t>(2 * c), static_cast<std::int32_t>(2 * c + 1)});
        // the line lies midway between the two faces
        const auto a = face_displacement(faces[c].a, snapshot.displacement_m);
        const auto b = face_displacement(faces[c].b, snapshot.displacement_m);
        for (std::size_t end = 0; end < 2; ++end) {
            const Vec2 u = 0.5 * (a[end] + b[end]);
            displacement.insert(displacement.end(), {static_cast<float>(u.x), static_cast<float>(u.y), 0.0F});
        }
        mode.push_back(static_cast<std::int32_t>(crack.mode));
        time.push_back(static_cast<float>(std::abs(crack.axial_strain)));
        step.push_back(crack.step);
        stress.push_back(static_cast<float>(crack.axial_stress_Pa * MPa));
        opening.push_back(c < snapshot.crack_opening_m.size() ? static_cast<float>(snapshot.crack_opening_m[c]) : 0.0F);
        energy.push_back(static_cast<float>(crack.energy_J));
    }
    VtuGrid grid(points, ends, VtkCell::line);
    grid.point_data("displacement_m", displacement, 3);
    grid.cell_data("mode", std::span<const std::int32_t>(mode));
    grid.cell_data("time", time);
    grid.cell_data("step", std::span<const std::int64_t>(step));
    grid.cell_data("axial_stress_at_break_MPa", stress);
    grid.cell_data("opening_m", opening);
    grid.cell_data("energy_J", energy);
    return grid.file(comment);
}

/// Acoustic events up to a moment, as points.
std::string events_vtu(const AcousticEmission& emission, const Snapshot& snapshot, const std::string& comment) {
    std::vector<double> points;
    std::vector<std::int32_t> vertices;
    std::vector<const AcousticEvent*> until;
    for (const AcousticEvent& event : emission.events)
        if (event.first_step <= snapshot.step) until.push_back(&event);
    for (const AcousticEvent* event : until) {
        vertices.push_back(static_cast<std::int32_t>(vertices.size()));
        points.insert(points.end(), {event->place.x, event->place.y, 0.0});
    }
    VtuGrid grid(points, vertices, VtkCell::vertex);
    for (const EventColumn& column : event_columns()) {
        std::vector<float> values;
        for (const AcousticEvent* event : until) values.push_back(static_cast<float>(column.value(*event)));
        grid.cell_data(column.name, values);
    }
    return grid.file(comment);
}

/// ParaView needs times that always grow: the magnitude of the axial strain, or the snapshot's number where it does not.
struct Times {
    std::vector<double> values;
    const char* meaning = "magnitude of the axial strain";
};

Times times(const std::vector<Snapshot>& snapshots) {
    Times times;
    for (const Snapshot& snapshot : snapshots) times.values.push_back(std::abs(snapshot.axial_strain));
    bool grows = true;
    for (std::size_t n = 1; n < times.values.size(); ++n) grows = grows && times.values[n] > times.values[n - 1];
    if (!grows) {
        for (std::size_t n = 0; n < times.values.size(); ++n) times.values[n] = static_cast<double>(n);
        times.meaning = "number of the snapshot";
    }
    return times;
}

}  // namespace

void write_vtu(const RunDirectory& directory, const TestResult& result, int threads) {
    if (!result.specimen) return;
    const std::string stem = test_stem(result);
    const std::string folder = stem + "-vtu/";
    const std::vector<CrackFaces> faces = find_crack_faces(*result.specimen, result.cracks);
    const VtuGrid undeformed = undeformed_grains(result.specimen->mesh, result.texture.phase_of_grain);
    const AcousticEmission& emission = result.emission;
    const Times time = times(result.snapshots);
    std::string collection = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- {}; {}. Part 0: grains; part 1: cracks (mode 0 tensile, 1 shear; time = magnitude of the "
        "axial "
        "strain at the break); part 2: acoustic events. timestep = {}. -->\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        stem, sign_convention, time.meaning);
    const auto grains_file = [&](std::size_t n) { return fmt::format("{}grains-{:03}.vtu", folder, n); };
    const auto cracks_file = [&](std::size_t n) { return fmt::format("{}cracks-{:03}.vtu", folder, n); };
    const auto events_file = [&](std::size_t n) { return fmt::format("{}events-{:03}.vtu", folder, n); };
    side_by_side(static_cast<int>(result.snapshots.size()), threads, [&](int number) {
        const auto n = static_cast<std::size_t>(number);
        const Snapshot& snapshot = result.snapshots[n];
        // numbers only: the label is free text, which an XML comment could not always hold
        const std::string comment = fmt::format("{}, snapshot {}, step {}, axial strain {}; {}", stem, n, snapshot.step,
                                                snapshot.axial_strain, sign_convention);
        directory.write_text(grains_file(n), grains_vtu(undeformed, snapshot, comment));
        directory.write_text(cracks_file(n), cracks_vtu(result, faces, snapshot, comment));
        directory.write_text(events_file(n), events_vtu(emission, snapshot, comment));
    });
    for (std::size_t n = 0; n < result.snapshots.size(); ++n) {
        collection += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", time.values[n], grains_file(n));
        collection += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"1\" file=\"{}\"/>\n", time.values[n], cracks_file(n));
        collection += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"2\" file=\"{}\"/>\n", time.values[n], events_file(n));
    }
    directory.write_text(stem + ".pvd", collection + "</Collection>\n</VTKFile>\n");
    std::error_code ignored;   // what an attempt that was ended has left beyond these
    for (std::size_t n = result.snapshots.size(); std::filesystem::remove(directory.path() / grains_file(n), ignored); ++n)
        for (const std::string& file : {cracks_file(n), events_file(n)}) std::filesystem::remove(directory.path() / file, ignored);
}

}  // namespace feldspar
