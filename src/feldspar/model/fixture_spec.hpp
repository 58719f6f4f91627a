// What loads or holds a specimen, as plain data: parts of its own boundary that are moved, plates and rollers in contact with it,
// pressures on its sides. A test lists its fixtures; attach() (model/fixtures.hpp) puts any list to any specimen and knows no
// test.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "feldspar/base/vec2.hpp"

namespace feldspar {

/// How a plate and grains touch.
struct PlateContact {
    double Kn_Pa_m = 0.0;  ///< normal stiffness per area
    double eta = 0.0;      ///< ks / kn
    double mu = 0.0;       ///< friction; 0 = frictionless
    bool glued = false;    ///< unbreakable in the normal direction and free along the plate (direct tension)

    bool operator==(const PlateContact&) const = default;
};

enum class FixtureKind {
    nodes,     ///< the nodes on a part of the boundary follow the fixture in the components that it imposes; flexible grains only
    plate,     ///< a rigid plate, curved jaw or roller, pressed against the boundary through one-point contacts
    membrane,  ///< plates side by side that move along their normals only, each under the pressure
    pressure   ///< a pressure on the edges themselves; flexible grains only
};

/// A part of the boundary: all edges of cells on it that meet every condition given.
struct BoundaryPart {
    std::string label;          ///< of the outline's edge; empty: any
    Vec2 facing{};              ///< not zero: the cosine between the outward normal and this unit vector is at least ...
    double least_cosine = 0.5;  ///< ... this: 60 degrees, beyond which no plate ever reaches an edge
    std::optional<Vec2> at;     ///< m; the edge comes within `reach_m` of this point ...
    double reach_m = 0.0;       ///< ... m
    std::optional<std::array<Vec2, 2>> inside{};  ///< m; the middle of the edge lies in the box with these opposite corners
    bool remaining = false;                       ///< of what no nodes or plates before it in the list have taken
};

/// Where on an edge a plate touches it.
enum class Touch {
    beside_centre,  ///< beside the centre of the body behind it; stiffness Kn x edge length x thickness
    under_circle,   ///< a body once: on its edge under the outermost point of its circle; stiffness Kn x diameter x thickness
    nearest_axis    ///< where it is nearest to the axis of a roller; stiffness Kn x edge length x thickness
};

/// One fixture, as data.
struct FixtureSpec {
    std::string name;  ///< in messages and records
    FixtureKind kind = FixtureKind::nodes;
    BoundaryPart part;
    Vec2 motion{};  ///< per unit of the loading motion; zero: at rest

    // nodes
    bool imposes_x = false, imposes_y = false;
    bool pins_middle = false;  ///< the node nearest to the middle of the part is held in the other component too

    // plate
    Vec2 normal{};         ///< unit vector from the specimen into the plate
    PlateContact contact;  ///< of membranes too
    Touch touch = Touch::beside_centre;
    double radius_m = 0.0;     ///< of the plate's surface: 0 flat, > 0 hollow as curved jaws, < 0 round as a roller
    std::optional<Vec2> axis;  ///< through which the normal of a curved surface goes, m
    std::string flat_label;    ///< under_circle: edges with this label are touched in their middle instead, with their own length

    // pressure, membrane; plate
    double pressure_Pa = 0.0;  ///< with which the test begins, compression positive
    bool pressed = false;      ///< a plate that is free along its normal, which must be along x or y, under a pressure or a force
    double force_N = 0.0;      ///< on a pressed plate, in place of the pressure
    double spring_Pa_m = 0.0;  ///< by which the pressure on a pressed plate grows as the specimen pushes it out

    // membrane
    int plates = 0;  ///< side by side; at least 1

    bool moves() const { return motion != Vec2{}; }
};

}  // namespace feldspar
