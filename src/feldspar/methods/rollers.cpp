#include "feldspar/methods/rollers.hpp"

#include "feldspar/methods/platens.hpp"

namespace feldspar {

FixtureSpec roller(const MethodInput& in, const char* name, Vec2 at, double radius_m, bool loads) {
    FixtureSpec roller;
    roller.name = name;
    roller.kind = FixtureKind::plate;
    roller.normal = {0.0, loads ? 1.0 : -1.0};
    roller.motion = {0.0, loads ? -1.0 : 0.0};
    roller.radius_m = -radius_m;
    roller.axis = at;
    roller.touch = Touch::nearest_axis;
    roller.part.facing = roller.normal;
    roller.part.at = at;
    roller.part.reach_m = radius_m;
    roller.contact = plate_contact(in);
    if (!loads) roller.contact.mu = 0.0;
    return roller;
}

std::vector<FixtureSpec> three_rollers(const MethodInput& in, const RollerPlaces& places) {
    return {roller(in, "loading roller", places.above, places.radius_m, true),
            roller(in, "left support", places.left, places.radius_m, false),
            roller(in, "right support", places.right, places.radius_m, false)};
}

}  // namespace feldspar
