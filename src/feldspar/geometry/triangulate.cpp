#include "feldspar/geometry/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Partition_traits_2.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/partition_2.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "feldspar/base/sort_in_buckets.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

using RegularVertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>;
using RegularData = CGAL::Triangulation_data_structure_2<RegularVertex, CGAL::Regular_triangulation_face_base_2<Kernel>>;
using Regular = CGAL::Regular_triangulation_2<Kernel, RegularData>;

using ConstrainedVertex = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using ConstrainedData =
    CGAL::Triangulation_data_structure_2<ConstrainedVertex, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Constrained = CGAL::Constrained_Delaunay_triangulation_2<Kernel, ConstrainedData>;

/// Turned so that the smallest number stands first, then sorted: the result does not depend on CGAL's own order.
void put_in_order(std::vector<std::array<int, 3>>& triangles) {
    std::size_t points = 0;
    for (auto& t : triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        points = std::max(points, static_cast<std::size_t>(t.front()) + 1);
    }
    sort_in_buckets(
        triangles, points, [](const auto& t) { return t.front(); }, std::less<>());
}

}  // namespace

RegularTriangulation regular_triangulation(std::span<const Vec2> sites, std::span<const double> weights) {
    assert(sites.size() == weights.size());
    std::vector<std::pair<Kernel::Weighted_point_2, int>> weighted;
    weighted.reserve(sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
        weighted.emplace_back(Kernel::Weighted_point_2(Kernel::Point_2(sites[i].x, sites[i].y), weights[i]), static_cast<int>(i));
    }
    const Regular regular(weighted.begin(), weighted.end());

    RegularTriangulation result;
    std::vector<char> seen(sites.size(), 0);
    result.triangles.reserve(2 * sites.size());
    for (const auto face : regular.finite_face_handles()) {
        result.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    for (const auto vertex : regular.finite_vertex_handles()) seen[static_cast<std::size_t>(vertex->info())] = 1;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!seen[i]) result.hidden.push_back(static_cast<int>(i));
    }
    put_in_order(result.triangles);
    return result;
}

std::vector<std::vector<int>> convex_partition(std::span<const Vec2> polygon) {
    using Points = std::vector<Kernel::Point_2>;
    using Map = CGAL::Pointer_property_map<Kernel::Point_2>::type;
    using Traits = CGAL::Partition_traits_2<Kernel, Map>;
    Points points;
    for (const Vec2 p : polygon) points.emplace_back(p.x, p.y);
    const Traits traits(CGAL::make_property_map(points));
    std::vector<std::size_t> ring(points.size());
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;
    std::vector<Traits::Polygon_2> parts;
    CGAL::approx_convex_partition_2(ring.begin(), ring.end(), std::back_inserter(parts), traits);
    std::vector<std::vector<int>> result;
    for (const auto& part : parts) {
        std::vector<int>& numbers = result.emplace_back();
        for (const std::size_t i : part.container()) numbers.push_back(static_cast<int>(i));
    }
    return result;
}

std::vector<std::array<int, 3>> triangulate_polygon(std::span<const Vec2> points, int boundary_count) {
    Constrained constrained;
    std::vector<Constrained::Vertex_handle> handles;
    handles.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        handles.push_back(constrained.insert(Kernel::Point_2(points[i].x, points[i].y)));
        handles.back()->info() = static_cast<int>(i);
    }
    const auto n = static_cast<std::size_t>(boundary_count);
    for (std::size_t k = 0; k < n; ++k) constrained.insert_constraint(handles[k], handles[(k + 1) % n]);
    std::vector<std::array<int, 3>> triangles;
    for (const auto face : constrained.finite_face_handles()) {
        const std::array<int, 3> t = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
        const Vec2 middle = (1.0 / 3.0) * (points[t[0]] + points[t[1]] + points[t[2]]);
        if (contains(points.first(n), middle)) triangles.push_back(t);
    }
    put_in_order(triangles);
    return triangles;
}

}  // namespace feldspar
