#include "feldspar/specimen/mesh_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/geometry/triangulate.hpp"

namespace feldspar {
namespace {

/// Nodes and triangles of one grain; nodes numbered from 0, the polygon's vertices first, then the centre.
struct OneGrain {
    std::vector<Vec2> nodes;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> edge_triangle;
};

double triangle_area(const OneGrain& grain, const std::array<int, 3>& t) {
    return 0.5 * cross(grain.nodes[t[1]] - grain.nodes[t[0]], grain.nodes[t[2]] - grain.nodes[t[0]]);
}

/// Smallest area (m^2) of the triangles from `centre` to the edges, negative where the centre does not see an edge.
double smallest_fan_area(const std::vector<Vec2>& corners, Vec2 centre) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < corners.size(); ++k) {
        least = std::min(least, 0.5 * cross(corners[k] - centre, corners[(k + 1) % corners.size()] - centre));
    }
    return least;
}

/// The polygon's kernel: what lies to the left of all its edges.
std::vector<Vec2> kernel_of(const std::vector<Vec2>& corners) {
    std::vector<Vec2> kernel = corners;
    for (std::size_t e = 0; e < corners.size() && kernel.size() >= 3; ++e) {
        const Vec2 a = corners[e], along = corners[(e + 1) % corners.size()] - a;
        std::vector<Vec2> kept;
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            const Vec2 p = kernel[k], q = kernel[(k + 1) % kernel.size()];
            const double dp = cross(along, p - a), dq = cross(along, q - a);
            if (dp >= 0.0) kept.push_back(p);
            if ((dp >= 0.0) != (dq >= 0.0)) kept.push_back(p + (dp / (dp - dq)) * (q - p));
        }
        kernel = std::move(kept);
    }
    return kernel;
}

Vec2 centre_of(const std::vector<Vec2>& corners, int cell) {
    if (const auto centre = centre_of_grain(corners)) return *centre;
    const Vec2 middle = centroid(corners);
    throw InputError({},
                     fmt::format("grain {} at ({:.6g}, {:.6g}) m bends around a corner of the outline and cannot be meshed", cell,
                                 middle.x, middle.y),
                     "grains smaller against the outline's re-entrant corners");
}

/// The fixed topology; `collapsed` is the ring edge that is collapsed, or -1 to keep the whole ring.
OneGrain fixed_topology(const std::vector<Vec2>& corners, Vec2 centre, int collapsed) {
    const int n = static_cast<int>(corners.size());
    OneGrain grain;
    grain.nodes = corners;
    grain.nodes.push_back(centre);
    // The collapsed edge's two ring nodes become one, numbered as the node after the edge: in a cell read from there, ring[0].
    std::vector<int> ring(corners.size());
    for (int k = 0; k < n; ++k) {
        if (k == collapsed) continue;
        const int before = (k + n - 1) % n;
        const Vec2 corner = before == collapsed ? 0.5 * (corners[before] + corners[k]) : corners[k];
        ring[k] = static_cast<int>(grain.nodes.size());
        grain.nodes.push_back(centre + 0.5 * (corner - centre));
    }
    if (collapsed >= 0) ring[collapsed] = ring[(collapsed + 1) % n];
    for (int k = 0; k < n; ++k) {
        const int next = (k + 1) % n;
        grain.edge_triangle.push_back(static_cast<int>(grain.triangles.size()));
        grain.triangles.push_back({k, next, ring[k]});
        if (k == collapsed) continue;
        grain.triangles.push_back({next, ring[next], ring[k]});
        grain.triangles.push_back({n, ring[k], ring[next]});
    }
    return grain;
}

/// No triangle without area, and each triangle around the centre at least 1 % of the ring's area.
bool is_good(const OneGrain& grain) {
    const int centre = static_cast<int>(grain.edge_triangle.size());
    double ring_area = 0.0, smallest_fan = std::numeric_limits<double>::infinity();
    for (const auto& t : grain.triangles) {
        const double area = triangle_area(grain, t);
        if (area <= 0.0) return false;
        if (t[0] != centre) continue;
        ring_area += area;
        smallest_fan = std::min(smallest_fan, area);
    }
    return smallest_fan >= 0.01 * ring_area;
}

OneGrain mesh_with_ring(const std::vector<Vec2>& corners, Vec2 centre) {
    const int n = static_cast<int>(corners.size());
    int shortest = n - 1;
    for (int k = 0; k < n; ++k) {
        if (norm(corners[(k + 1) % n] - corners[k]) < norm(corners[(shortest + 1) % n] - corners[shortest])) shortest = k;
    }
    if (n > 3) {
        OneGrain grain = fixed_topology(corners, centre, shortest);
        if (is_good(grain)) return grain;
    }
    return fixed_topology(corners, centre, -1);
}

/// The centre and the points of a triangular lattice around it that keep 0.6 spacings from the cell's edges.
std::vector<Vec2> lattice_points(const std::vector<Vec2>& corners, Vec2 centre, double spacing) {
    std::vector<Vec2> points = {centre};
    const Box box = bounding_box(std::span<const Vec2>(corners));
    const double row_height = spacing * std::sqrt(0.75);
    const int rows = static_cast<int>(norm(box.upper - box.lower) / row_height) + 1;
    for (int r = -rows; r <= rows; ++r) {
        for (int c = -2 * rows; c <= 2 * rows; ++c) {
            const Vec2 p = centre + Vec2{spacing * (c + 0.5 * (r % 2 == 0 ? 0 : 1)), row_height * r};
            if ((r == 0 && c == 0) || !contains(corners, p)) continue;
            if (distance_to_boundary(corners, p) > 0.6 * spacing) points.push_back(p);
        }
    }
    return points;
}

/// A triangulation of nv boundary and m inner points has 2 m + nv - 2 triangles: finds the spacing that comes nearest to the
/// number asked for. The spacing alone is varied, by a factor of 1.05, from coarse to fine, so the result is deterministic.
OneGrain mesh_finely(const std::vector<Vec2>& corners, Vec2 centre, int wanted_triangles) {
    const int n = static_cast<int>(corners.size());
    const double wanted = std::max(1.0, 0.5 * (wanted_triangles - n + 2));
    std::vector<Vec2> best = {centre};
    double spacing = std::sqrt(signed_area(corners) / std::max(2.0, wanted)) * 1.5;
    for (int trial = 0; trial < 40; ++trial, spacing /= 1.05) {
        std::vector<Vec2> points = lattice_points(corners, centre, spacing);
        const auto miss = [&](const std::vector<Vec2>& p) { return std::abs(static_cast<double>(p.size()) - wanted); };
        const bool enough = static_cast<double>(points.size()) >= wanted;
        if (miss(points) < miss(best)) best = std::move(points);
        if (enough) break;
    }
    OneGrain grain;
    grain.nodes = corners;
    grain.nodes.insert(grain.nodes.end(), best.begin(), best.end());
    grain.triangles = triangulate_polygon(grain.nodes, n);
    grain.edge_triangle.assign(corners.size(), -1);
    for (int t = 0; t < std::ssize(grain.triangles); ++t) {
        for (int k = 0; k < 3; ++k) {
            const int a = grain.triangles[t][k], b = grain.triangles[t][(k + 1) % 3];
            if (a < n && b == (a + 1) % n) grain.edge_triangle[a] = t;
        }
    }
    return grain;
}

/// Where a vertex lies in the middle of a straight side, as at the end of a notch, a triangulation may join it to both ends of
/// the side.
bool has_flat_triangle(const OneGrain& grain, double cell_area) {
    return std::any_of(grain.triangles.begin(), grain.triangles.end(),
                       [&](const auto& t) { return triangle_area(grain, t) <= 1e-9 * cell_area; });
}

}  // namespace

std::optional<Vec2> centre_of_grain(const std::vector<Vec2>& corners) {
    const double area = signed_area(corners);
    const Vec2 middle = centroid(corners);
    if (smallest_fan_area(corners, middle) > 1e-6 * area) return middle;
    const std::vector<Vec2> kernel = kernel_of(corners);
    if (kernel.size() >= 3 && signed_area(kernel) > 0.0) {
        const Vec2 seeing = centroid(kernel);
        if (smallest_fan_area(corners, seeing) > 1e-6 * area) return seeing;
    }
    return std::nullopt;
}

namespace {

/// The grains of one share, numbered from the share's first.
struct MeshPart {
    GrainMesh mesh;
    std::exception_ptr problem;  ///< of the first grain that cannot be meshed; those behind it are left out
};

void add_grain(GrainMesh& mesh, const Tessellation& cells, int g, int triangles_per_grain) {
    const std::vector<Vec2> corners = corners_of_cell(cells, g);
    const Vec2 centre = centre_of(corners, g);
    OneGrain grain =
        triangles_per_grain > 0 ? mesh_finely(corners, centre, triangles_per_grain) : mesh_with_ring(corners, centre);
    if (triangles_per_grain > 0 && has_flat_triangle(grain, signed_area(corners))) grain = mesh_with_ring(corners, centre);

    const int first_node = static_cast<int>(mesh.nodes.size());
    const int first_triangle = static_cast<int>(mesh.triangles.size());
    mesh.nodes.insert(mesh.nodes.end(), grain.nodes.begin(), grain.nodes.end());
    for (const auto& t : grain.triangles) {
        if (triangle_area(grain, t) <= 0.0) throw NumericalError(fmt::format("grain {} has a triangle without area", g));
        mesh.triangles.push_back({first_node + t[0], first_node + t[1], first_node + t[2]});
    }
    for (const int t : grain.edge_triangle) {
        if (t < 0) throw NumericalError(fmt::format("an edge of grain {} has no triangle", g));
        mesh.edge_triangle.push_back(first_triangle + t);
    }
    mesh.vertex_count.push_back(static_cast<int>(corners.size()));
    mesh.centre_node.push_back(first_node + static_cast<int>(corners.size()));
    mesh.node_begin.push_back(static_cast<int>(mesh.nodes.size()));
    mesh.triangle_begin.push_back(static_cast<int>(mesh.triangles.size()));
    mesh.edge_begin.push_back(static_cast<int>(mesh.edge_triangle.size()));
}

/// Puts the shares behind each other, and lets each go when it is in.
GrainMesh in_one(std::vector<MeshPart>& parts) {
    GrainMesh whole;
    const auto reserve = [&](auto GrainMesh::*list) {
        std::size_t count = 0;
        for (const MeshPart& part : parts) count += (part.mesh.*list).size();
        (whole.*list).reserve(count + 1);
    };
    reserve(&GrainMesh::nodes);
    reserve(&GrainMesh::triangles);
    for (const auto list : {&GrainMesh::node_begin, &GrainMesh::triangle_begin, &GrainMesh::vertex_count, &GrainMesh::centre_node,
                            &GrainMesh::edge_begin, &GrainMesh::edge_triangle})
        reserve(list);
    for (const auto list : {&GrainMesh::node_begin, &GrainMesh::triangle_begin, &GrainMesh::edge_begin})
        (whole.*list).push_back(0);
    for (MeshPart& part : parts) {
        const int nodes = static_cast<int>(whole.nodes.size()), triangles = static_cast<int>(whole.triangles.size()),
                  edges = static_cast<int>(whole.edge_triangle.size());
        const auto add = [&](std::vector<int> GrainMesh::*list, int more) {
            for (const int number : part.mesh.*list) (whole.*list).push_back(more + number);
        };
        whole.nodes.insert(whole.nodes.end(), part.mesh.nodes.begin(), part.mesh.nodes.end());
        for (const auto& [a, b, c] : part.mesh.triangles) whole.triangles.push_back({nodes + a, nodes + b, nodes + c});
        add(&GrainMesh::node_begin, nodes);
        add(&GrainMesh::triangle_begin, triangles);
        add(&GrainMesh::edge_begin, edges);
        add(&GrainMesh::vertex_count, 0);
        add(&GrainMesh::centre_node, nodes);
        add(&GrainMesh::edge_triangle, triangles);
        part = {};
    }
    return whole;
}

}  // namespace

GrainMesh mesh_grains(const Tessellation& cells, int triangles_per_grain, const StageControl& control) {
    const int count = static_cast<int>(cells.cells.size());
    std::vector<MeshPart> parts(static_cast<std::size_t>(control.team ? control.team->size() : 1));
    in_shares(control.team, count, [&](IndexRange grains, int thread) {
        MeshPart& part = parts[static_cast<std::size_t>(thread)];
        try {
            for (int g = grains.begin; g < grains.end; ++g) {
                if (thread == 0 && g % 1000 == 0) control.done(static_cast<double>(g) / static_cast<double>(grains.end));
                add_grain(part.mesh, cells, g, triangles_per_grain);
            }
        } catch (...) {
            part.problem = std::current_exception();
        }
    });
    for (const MeshPart& part : parts)  // the first share that failed has the first grain that does, however many there are
        if (part.problem) std::rethrow_exception(part.problem);
    return in_one(parts);
}

}  // namespace feldspar
