#include "feldspar/model/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/log_normal.hpp"

namespace feldspar {
namespace {

// A factor of mean 1 with this coefficient of variation, log-normal.
double scattered(RandomStream& random, double variation) {
    return variation == 0.0 ? 1.0 : log_normal_factor(variation, random.normal());
}

std::vector<std::vector<Vec2>> draw(const JointSet& set, const std::string& name, const Specimen& specimen) {
    RandomStream random(specimen.seed, "joint set " + name);
    const Box box = bounding_box(specimen.mesh.nodes);
    const Vec2 centre = 0.5 * (box.lower + box.upper), along{std::cos(set.dip_rad), std::sin(set.dip_rad)}, across = rot90(along);
    const double reach = 0.5 * norm(box.upper - box.lower);
    std::vector<std::vector<Vec2>> traces;
    double place = -reach - set.spacing_m * random.uniform();
    for (; place < reach; place += set.spacing_m * scattered(random, set.spacing_variation)) {
        const Vec2 middle = centre + place * across;
        const auto add = [&](double from, double to) {
            const double turn = set.dip_deviation_rad * random.normal();
            const Vec2 c = middle + 0.5 * (from + to) * along, half = turned(0.5 * (to - from) * along, turn);
            traces.push_back({c - half, c + half});
        };
        if (set.length_m == 0.0) {
            add(-2.0 * reach, 2.0 * reach);
            continue;
        }
        const double gap = set.length_m * (1.0 - set.persistence) / set.persistence;
        double from = -reach - (set.length_m + gap) * random.uniform();
        while (from < reach) {
            const double length = set.length_m * scattered(random, set.length_variation);
            add(from, from + length);
            from += length + gap;
        }
    }
    return traces;
}

// Where a point lies beside a trace: the nearest segment, and whether the nearest point is one of its ends.
struct Beside {
    double distance = std::numeric_limits<double>::infinity();
    Vec2 from, along;
    bool beyond = false;
};

Beside nearest(const std::vector<Vec2>& trace, Vec2 x) {
    Beside best;
    for (std::size_t i = 0; i + 1 < trace.size(); ++i) {
        const Vec2 line = trace[i + 1] - trace[i];
        const double t = dot(x - trace[i], line) / dot(line, line), inside = std::clamp(t, 0.0, 1.0);
        const double distance = norm(x - (trace[i] + inside * line));
        if (distance >= best.distance) continue;
        best = {distance, trace[i], line, (t < 0.0 && i == 0) || (t > 1.0 && i + 2 == trace.size())};
    }
    return best;
}

}  // namespace

std::vector<std::vector<Vec2>> traces_of(const JointSpec& joint, const Specimen& specimen) {
    return joint.set ? draw(*joint.set, joint.name, specimen) : joint.lines_m;
}

JointEdges::JointEdges(const Specimen& specimen, const JointSpec& joint) {
    const std::vector<Cell>& cells = specimen.cells.cells;
    if (!joint.cut.empty()) {
        std::string known;
        for (int n = 0; n < std::ssize(specimen.outline.cutouts); ++n) {
            const Cutout& cut = specimen.outline.cutouts[n];
            if (!cut.joined) continue;
            const std::string& label = specimen.outline.edge_labels[cut.first_edge];
            known += (known.empty() ? "\"" : ", \"") + label + "\"";
            if (label != joint.cut) continue;
            for (int c = 0; c < std::ssize(cells); ++c)
                for (std::size_t k = 0; k < cells[c].seams.size(); ++k)
                    if (cells[c].seams[k] == n && cells[c].neighbours[k] > c) pairs_.insert({c, cells[c].neighbours[k]});
        }
        if (pairs_.empty())
            throw InputError({.key = "material.joint.cut"},
                             fmt::format("the specimen has no cut \"{}\" whose faces are joined", joint.cut),
                             known.empty() ? "a notch of width 0 with joined = true" : known);
        return;
    }
    const auto centre = [&](int c) { return specimen.mesh.nodes[specimen.mesh.centre_node[c]]; };
    for (const std::vector<Vec2>& trace : traces_of(joint, specimen)) {
        Box reach = bounding_box(trace);
        const double margin = specimen.quality.cell_sizes.maximum_m;
        const auto is_near = [&](Vec2 x) {
            return x.x > reach.lower.x - margin && x.x < reach.upper.x + margin && x.y > reach.lower.y - margin &&
                   x.y < reach.upper.y + margin;
        };
        for (int c = 0; c < std::ssize(cells); ++c) {
            if (!is_near(centre(c))) continue;
            const int edges = static_cast<int>(cells[c].vertices.size());
            for (int k = 0; k < edges; ++k) {
                const int other = cells[c].neighbours[k];
                if (other <= c) continue;
                const Vec2 middle = 0.5 * (specimen.cells.vertices[cells[c].vertices[k]] +
                                           specimen.cells.vertices[cells[c].vertices[(k + 1) % edges]]);
                const Beside beside = nearest(trace, middle);
                if (beside.beyond || beside.distance > margin) continue;
                if ((cross(beside.along, centre(c) - beside.from) > 0.0) !=
                    (cross(beside.along, centre(other) - beside.from) > 0.0))
                    pairs_.insert({c, other});
            }
        }
    }
    if (pairs_.empty() && !joint.set) {
        const Box box = bounding_box(specimen.mesh.nodes);
        throw InputError(
            {.key = "joint"}, fmt::format("no grain edge lies along the joint \"{}\"", joint.name),
            fmt::format("a trace within x = {:.4g} ... {:.4g} mm, y = {:.4g} ... {:.4g} mm that is longer than a grain",
                        1e3 * box.lower.x, 1e3 * box.upper.x, 1e3 * box.lower.y, 1e3 * box.upper.y));
    }
}

void require_no_loose_grain(const Specimen& specimen, const std::vector<JointSpec>& joints,
                            const std::vector<const JointEdges*>& edges) {
    const std::vector<Cell>& cells = specimen.cells.cells;
    for (int c = 0; c < std::ssize(cells); ++c) {
        bool held = false;
        std::string names;
        for (const int other : cells[c].neighbours) {
            if (other < 0) {
                held = true;  // on the boundary: plates and pressures may hold it
                continue;
            }
            bool open = false;
            for (std::size_t j = 0; j < joints.size(); ++j) {
                if (!edges[j]->holds(c, other)) continue;
                open = joints[j].without_strength();
                if (open && names.find("\"" + joints[j].name + "\"") == std::string::npos)
                    names += (names.empty() ? "\"" : ", \"") + joints[j].name + "\"";
            }
            held = held || !open;
        }
        if (held) continue;
        const Vec2 place = specimen.mesh.nodes[specimen.mesh.centre_node[c]];
        throw InputError(
            {.key = "joint"},
            fmt::format("joints without strength ({}) cut the grain at ({:.4g} mm, {:.4g} mm) off from all its neighbours", names,
                        1e3 * place.x, 1e3 * place.y),
            "joints two grains or more apart from each other, or some strength in one of them");
    }
}

}  // namespace feldspar
