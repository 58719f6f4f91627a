// Fields for ParaView: a .pvd that lists a set of named blocks for each snapshot: grains, their edges, contacts, cracks, acoustic
// events. Positions are undeformed; "Warp By Vector" with displacement_m shows the deformed body and the open cracks.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "feldspar/base/parallel.hpp"
#include "feldspar/output/crack_geometry.hpp"
#include "feldspar/output/event_columns.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/report_assets.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/test_fields.hpp"
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

/// The edges of each grain: sides of its triangles that no other triangle of the grain shares.
std::vector<std::vector<std::array<int, 2>>> grain_edges(const TestFields& fields) {
    std::vector<std::map<std::array<int, 2>, std::array<int, 2>>> open;  // of each grain, by the smaller node
    for (std::size_t t = 0; t < fields.triangles.size(); ++t) {
        const auto grain = static_cast<std::size_t>(fields.grain[t]);
        if (grain >= open.size()) open.resize(grain + 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::array side{fields.triangles[t][k], fields.triangles[t][(k + 1) % 3]};
            const std::array key{std::min(side[0], side[1]), std::max(side[0], side[1])};
            if (!open[grain].erase(key)) open[grain].emplace(key, side);
        }
    }
    std::vector<std::vector<std::array<int, 2>>> edges(open.size());
    for (std::size_t g = 0; g < open.size(); ++g)
        for (const auto& [key, side] : open[g]) edges[g].push_back(side);
    return edges;
}

/// Where a line lies between two grains, and by which nodes of either it moves.
class LineBetweenGrains {
public:
    LineBetweenGrains(const TestFields& fields, const std::vector<std::vector<std::array<int, 2>>>& edges, int grain_a,
                      int grain_b, Vec2 from, Vec2 to)
        : from_(from), to_(to), a_(face(fields, edges, grain_a)), b_(face(fields, edges, grain_b)) {}

    /// Adds its two ends, and their displacements, midway between the faces.
    void add(const Snapshot& snapshot, std::vector<double>& points, std::vector<std::int32_t>& ends,
             std::vector<float>& displacement) const {
        const auto first = static_cast<std::int32_t>(points.size() / 3);
        ends.insert(ends.end(), {first, first + 1});
        points.insert(points.end(), {from_.x, from_.y, 0.0, to_.x, to_.y, 0.0});
        const auto a = face_displacement(a_.node_0 < 0 ? b_ : a_, snapshot.displacement_m),
                   b = face_displacement(b_.node_0 < 0 ? a_ : b_, snapshot.displacement_m);
        for (std::size_t end = 0; end < 2; ++end) {
            const Vec2 u = 0.5 * (a[end] + b[end]);
            displacement.insert(displacement.end(), {static_cast<float>(u.x), static_cast<float>(u.y), 0.0F});
        }
    }

private:
    static double fraction_along(Vec2 start, Vec2 end, Vec2 point) {
        const Vec2 edge = end - start;
        const double length2 = dot(edge, edge);
        return length2 > 0.0 ? std::clamp(dot(point - start, edge) / length2, 0.0, 1.0) : 0.0;
    }

    // The edge of the grain on which the line lies: the one nearest to both of its ends.
    CrackFace face(const TestFields& fields, const std::vector<std::vector<std::array<int, 2>>>& edges, int grain) const {
        CrackFace best;
        if (grain < 0 || static_cast<std::size_t>(grain) >= edges.size()) return best;
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& [node_0, node_1] : edges[static_cast<std::size_t>(grain)]) {
            const Vec2 start = fields.nodes[static_cast<std::size_t>(node_0)],
                       end = fields.nodes[static_cast<std::size_t>(node_1)];
            const double at_from = fraction_along(start, end, from_), at_to = fraction_along(start, end, to_);
            const double distance = norm(start + at_from * (end - start) - from_) + norm(start + at_to * (end - start) - to_);
            if (distance >= nearest) continue;
            nearest = distance;
            best = {node_0, node_1, at_from, at_to};
        }
        return best;
    }

    Vec2 from_, to_;
    CrackFace a_, b_;
};

/// What the blocks of all snapshots have in common.
class Blocks {
public:
    explicit Blocks(const TestFields& fields)
        : fields_(fields), grains_(undeformed_grains()), outlines_(undeformed_outlines(grain_edges(fields))) {
        const auto edges = grain_edges(fields);
        for (const ContactPlace& c : fields.contacts) contacts_.emplace_back(fields, edges, c.grain_a, c.grain_b, c.from, c.to);
        for (const Crack& c : fields.cracks) cracks_.emplace_back(fields, edges, c.grain_a, c.grain_b, c.from, c.to);
        for (std::size_t c = 0; c < fields.events.size(); ++c) {
            if (fields.events[c].name == "x_m") x_ = &fields.events[c].values;
            if (fields.events[c].name == "y_m") y_ = &fields.events[c].values;
            if (fields.events[c].name == "first_step") first_step_ = &fields.events[c].values;
        }
    }

    std::string grains(const Snapshot& snapshot, const std::string& comment) const {
        VtuGrid grid = grains_;
        const PrincipalStresses principal = principal_stresses(snapshot);
        grid.point_data("displacement_m", displacements(snapshot), 3);
        grid.cell_data("damage", std::span<const float>(snapshot.damage));
        grid.cell_data("stress_xx_MPa", floats_in_MPa(snapshot.stress_xx_Pa));
        grid.cell_data("stress_yy_MPa", floats_in_MPa(snapshot.stress_yy_Pa));
        grid.cell_data("stress_xy_MPa", floats_in_MPa(snapshot.stress_xy_Pa));
        grid.cell_data("sigma_1_MPa", principal.sigma_1_MPa);
        grid.cell_data("sigma_3_MPa", principal.sigma_3_MPa);
        grid.cell_data("mean_stress_MPa", principal.mean_MPa);
        return grid.file(comment);
    }

    std::string grain_outlines(const Snapshot& snapshot, const std::string& comment) const {
        VtuGrid grid = outlines_;
        grid.point_data("displacement_m", displacements(snapshot), 3);
        return grid.file(comment);
    }

    /// Contacts that are not broken.
    std::string contacts(const Snapshot& snapshot, const std::string& comment) const {
        std::vector<double> points;
        std::vector<std::int32_t> ends, grain_a, grain_b;
        std::vector<float> displacement, damage, normal, shear;
        for (std::size_t c = 0; c < contacts_.size() && c < snapshot.contact_damage.size(); ++c) {
            if (snapshot.contact_damage[c] >= 1.0F) continue;
            contacts_[c].add(snapshot, points, ends, displacement);
            grain_a.push_back(fields_.contacts[c].grain_a);
            grain_b.push_back(fields_.contacts[c].grain_b);
            damage.push_back(snapshot.contact_damage[c]);
            normal.push_back(snapshot.contact_normal_N[c]);
            shear.push_back(snapshot.contact_shear_N[c]);
        }
        VtuGrid grid(points, ends, VtkCell::line);
        grid.point_data("displacement_m", displacement, 3);
        grid.cell_data("grain_a", std::span<const std::int32_t>(grain_a));
        grid.cell_data("grain_b", std::span<const std::int32_t>(grain_b));
        grid.cell_data("damage", damage);
        grid.cell_data("normal_force_N", normal);
        grid.cell_data("shear_force_N", shear);
        return grid.file(comment);
    }

    std::string cracks(const Snapshot& snapshot, const std::string& comment) const {
        std::vector<double> points;
        std::vector<std::int32_t> ends, mode;
        std::vector<float> displacement, time, stress, opening, energy;
        std::vector<std::int64_t> step;
        const auto count = std::min(cracks_.size(), static_cast<std::size_t>(std::max(snapshot.cracks, 0)));
        for (std::size_t c = 0; c < count; ++c) {
            const Crack& crack = fields_.cracks[c];
            cracks_[c].add(snapshot, points, ends, displacement);
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

    /// Acoustic events up to the moment, as points.
    std::string events(const Snapshot& snapshot, const std::string& comment) const {
        std::vector<double> points;
        std::vector<std::int32_t> vertices;
        std::vector<std::size_t> until;
        if (x_ != nullptr && y_ != nullptr && first_step_ != nullptr)
            for (std::size_t e = 0; e < x_->size(); ++e)
                if ((*first_step_)[e] <= static_cast<double>(snapshot.step)) until.push_back(e);
        for (const std::size_t e : until) {
            vertices.push_back(static_cast<std::int32_t>(vertices.size()));
            points.insert(points.end(), {(*x_)[e], (*y_)[e], 0.0});
        }
        VtuGrid grid(points, vertices, VtkCell::vertex);
        for (const EventValues& column : fields_.events) {
            std::vector<float> values;
            for (const std::size_t e : until) values.push_back(static_cast<float>(column.values[e]));
            grid.cell_data(column.name, values);
        }
        return grid.file(comment);
    }

private:
    std::vector<double> undeformed_points() const {
        std::vector<double> points;
        for (const Vec2 node : fields_.nodes) points.insert(points.end(), {node.x, node.y, 0.0});
        return points;
    }

    VtuGrid undeformed_grains() const {
        std::vector<std::int32_t> corners;
        for (const auto& triangle : fields_.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
        VtuGrid grid(undeformed_points(), corners, VtkCell::triangle);
        grid.cell_data("grain", std::span<const std::int32_t>(fields_.grain));
        if (!fields_.mineral.empty()) {
            std::vector<std::int32_t> mineral;
            for (const int g : fields_.grain) mineral.push_back(fields_.mineral[static_cast<std::size_t>(g)]);
            grid.cell_data("mineral", std::span<const std::int32_t>(mineral));
        }
        return grid;
    }

    VtuGrid undeformed_outlines(const std::vector<std::vector<std::array<int, 2>>>& edges) const {
        std::vector<std::int32_t> ends, grain;
        for (std::size_t g = 0; g < edges.size(); ++g)
            for (const auto& [node_0, node_1] : edges[g]) {
                ends.insert(ends.end(), {node_0, node_1});
                grain.push_back(static_cast<std::int32_t>(g));
            }
        VtuGrid grid(undeformed_points(), ends, VtkCell::line);
        grid.cell_data("grain", std::span<const std::int32_t>(grain));
        return grid;
    }

    static std::vector<float> displacements(const Snapshot& snapshot) {
        std::vector<float> displacement;
        for (const Vec2 u : snapshot.displacement_m)
            displacement.insert(displacement.end(), {static_cast<float>(u.x), static_cast<float>(u.y), 0.0F});
        return displacement;
    }

    const TestFields& fields_;
    VtuGrid grains_, outlines_;
    std::vector<LineBetweenGrains> contacts_, cracks_;
    const std::vector<double>*x_ = nullptr, *y_ = nullptr, *first_step_ = nullptr;  // of the events
};

struct Block {
    const char* name;
    std::string (Blocks::*file)(const Snapshot&, const std::string&) const;
};

constexpr std::array blocks_in_order{Block{"grains", &Blocks::grains}, Block{"grain_edges", &Blocks::grain_outlines},
                                     Block{"contacts", &Blocks::contacts}, Block{"cracks", &Blocks::cracks},
                                     Block{"events", &Blocks::events}};

/// The script by which ParaView shows a test.
std::string script_of(const std::string& stem, const std::filesystem::path& folder) {
    std::string text = asset_paraview_py;
    const auto fill = [&](const std::string& mark, const std::string& value) {
        for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size()))
            text.replace(at, mark.size(), value);
    };
    std::string quoted;
    for (const char c : folder.string()) quoted += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
    fill("{{stem}}", stem);
    fill("{{folder}}", quoted);
    return text;
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

TestFields fields_of(const TestResult& result) {
    TestFields fields;
    fields.stem = test_stem(result);
    fields.contacts = result.grain_contacts;
    fields.cracks = result.cracks;
    fields.snapshots = result.snapshots;
    for (Snapshot& snapshot : fields.snapshots)  // an archive keeps seven digits of them
        for (std::vector<double>* stresses : {&snapshot.stress_xx_Pa, &snapshot.stress_yy_Pa, &snapshot.stress_xy_Pa})
            for (double& stress : *stresses) stress = static_cast<float>(stress);
    fields.mineral = result.texture.phase_of_grain;
    if (!result.emission.events.empty())
        for (const EventColumn& column : event_columns()) {
            fields.events.push_back({column.name, {}});
            for (const AcousticEvent& event : result.emission.events) fields.events.back().values.push_back(column.value(event));
        }
    if (!result.specimen) return fields;
    const GrainMesh& mesh = result.specimen->mesh;
    fields.nodes = mesh.nodes;
    fields.triangles = mesh.triangles;
    fields.grain.assign(mesh.triangles.size(), 0);
    for (std::size_t g = 0; g + 1 < mesh.triangle_begin.size(); ++g)
        std::fill(fields.grain.begin() + mesh.triangle_begin[g], fields.grain.begin() + mesh.triangle_begin[g + 1],
                  static_cast<int>(g));
    return fields;
}

void write_paraview(const RunDirectory& directory, const TestFields& fields, int threads) {
    if (fields.nodes.empty()) return;
    const std::string& stem = fields.stem;
    const Blocks blocks(fields);
    const Times time = times(fields.snapshots);
    const auto file = [&](const char* block, std::size_t n, const char* kind) {
        return fmt::format("{}-{:03}.{}", block, n, kind);
    };
    side_by_side(static_cast<int>(fields.snapshots.size()), threads, [&](int number) {
        const auto n = static_cast<std::size_t>(number);
        const Snapshot& snapshot = fields.snapshots[n];
        // numbers only: the label is free text, which an XML comment could not always hold
        const std::string comment =
            fmt::format("snapshot {}, step {}, axial strain {}; {}", n, snapshot.step, snapshot.axial_strain, sign_convention);
        std::string list = fmt::format(
            "<?xml version=\"1.0\"?>\n<!-- {} -->\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
            "byte_order=\"LittleEndian\">\n<vtkMultiBlockDataSet>\n",
            comment);
        for (std::size_t b = 0; b < blocks_in_order.size(); ++b) {
            const Block& block = blocks_in_order[b];
            directory.write_text(stem + "/" + file(block.name, n, "vtu"), (blocks.*block.file)(snapshot, comment));
            list += fmt::format("<DataSet index=\"{}\" name=\"{}\" file=\"{}\"/>\n", b, block.name, file(block.name, n, "vtu"));
        }
        directory.write_text(stem + "/" + file("snapshot", n, "vtm"), list + "</vtkMultiBlockDataSet>\n</VTKFile>\n");
    });
    std::string collection = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- feldspar fields for ParaView 2; {}. Blocks: grains, grain_edges, contacts (not broken; "
        "force > 0: compression), cracks (mode 0 tensile, 1 shear; "
        "time = magnitude of the axial strain at the break), events (acoustic). timestep = {}. -->\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
        sign_convention, time.meaning);
    for (std::size_t n = 0; n < fields.snapshots.size(); ++n)
        collection += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}/{}\"/>\n", time.values[n], stem,
                                  file("snapshot", n, "vtm"));
    directory.write_text(stem + ".pvd", collection + "</Collection>\n</VTKFile>\n");
    directory.write_text(stem + ".py", script_of(stem, std::filesystem::absolute(directory.path())));
    std::error_code ignored;  // what an earlier export has left beyond these
    for (std::size_t n = fields.snapshots.size();
         std::filesystem::remove(directory.path() / stem / file("snapshot", n, "vtm"), ignored); ++n)
        for (const Block& block : blocks_in_order)
            std::filesystem::remove(directory.path() / stem / file(block.name, n, "vtu"), ignored);
}

}  // namespace feldspar
