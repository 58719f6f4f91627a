#include "feldspar/output/crack_geometry.hpp"

#include <algorithm>
#include <limits>

namespace feldspar {

namespace {

double fraction_along(Vec2 start, Vec2 end, Vec2 point) {
    const Vec2 edge = end - start;
    const double length2 = dot(edge, edge);
    return length2 > 0.0 ? std::clamp(dot(point - start, edge) / length2, 0.0, 1.0) : 0.0;
}

/// The edge of `grain` that faces `other` and lies nearest to the crack.
CrackFace find_face(const Specimen& specimen, const Crack& crack, int grain, int other) {
    CrackFace best;
    if (grain < 0 || static_cast<std::size_t>(grain) >= specimen.cells.cells.size()) return best;
    const Cell& cell = specimen.cells.cells[static_cast<std::size_t>(grain)];
    const int first = specimen.mesh.node_begin[static_cast<std::size_t>(grain)];
    const int count = static_cast<int>(cell.vertices.size());
    double nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < count; ++k) {
        if (cell.neighbours[static_cast<std::size_t>(k)] != other) continue;
        const CrackFace face{.node_0 = first + k, .node_1 = first + (k + 1) % count};  // a grain's first nodes are its vertices
        const Vec2 start = specimen.mesh.nodes[static_cast<std::size_t>(face.node_0)];
        const Vec2 end = specimen.mesh.nodes[static_cast<std::size_t>(face.node_1)];
        const double distance = norm(start + fraction_along(start, end, crack.place) * (end - start) - crack.place);
        if (distance >= nearest) continue;
        nearest = distance;
        best = face;
        best.fraction_from = fraction_along(start, end, crack.from);
        best.fraction_to = fraction_along(start, end, crack.to);
    }
    return best;
}

}  // namespace

std::vector<CrackFaces> find_crack_faces(const Specimen& specimen, const std::vector<Crack>& cracks) {
    std::vector<CrackFaces> faces;
    faces.reserve(cracks.size());
    for (const Crack& crack : cracks) {
        faces.push_back(
            {find_face(specimen, crack, crack.grain_a, crack.grain_b), find_face(specimen, crack, crack.grain_b, crack.grain_a)});
    }
    return faces;
}

std::array<Vec2, 2> face_displacement(const CrackFace& face, const std::vector<Vec2>& displacement_m) {
    if (face.node_0 < 0) return {};
    const Vec2 start = displacement_m[static_cast<std::size_t>(face.node_0)];
    const Vec2 along = displacement_m[static_cast<std::size_t>(face.node_1)] - start;
    return {start + face.fraction_from * along, start + face.fraction_to * along};
}

}  // namespace feldspar
