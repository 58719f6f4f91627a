#include "feldspar/methods/platens.hpp"

#include <algorithm>

#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/fixtures.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

FixtureSpec platen(const MethodInput& in, bool top) {
    FixtureSpec platen;
    platen.name = platen.part.label = top ? top_label : bottom_label;
    platen.motion = {0.0, top ? -method_of(in.test).loading.sign : 0.0};
    if (in.model.kind == GrainKind::flexible &&
        !(in.test.plate_mu.value_or(0.0) > 0.0)) {  // without friction a row of nodes is such a plate
        platen.kind = FixtureKind::nodes;
        platen.imposes_y = true;
        platen.pins_middle = !top;
    } else {
        platen.kind = FixtureKind::plate;
        platen.normal = {0.0, top ? 1.0 : -1.0};
        platen.contact = plate_contact(in);
    }
    return platen;
}

FixtureSpec membrane(const MethodInput& in, bool left) {
    FixtureSpec side;
    side.name = left ? "left membrane" : "right membrane";
    side.kind = FixtureKind::membrane;
    side.normal = {left ? -1.0 : 1.0, 0.0};
    side.part.facing = side.normal;
    side.part.least_cosine = 0.0;  // a side that is not vertical is refused, not left out
    side.part.remaining = true;
    side.contact = {in.contact.Kn_Pa_m, in.contact.eta, 0.0, false};
    side.plates = in.test.membrane_plates;
    side.pressure_Pa = in.test.sigma3_Pa;
    return side;
}

}  // namespace

PlateContact plate_contact(const MethodInput& in) {
    const MethodSpecimen& usual = method_of(in.test).specimen;
    PlateContact contact;
    contact.Kn_Pa_m = in.test.plate_Kn_Pa_m.value_or(in.test.plate_stiffness_factor * in.contact.Kn_Pa_m);
    contact.eta = in.contact.eta;
    contact.mu = in.test.plate_mu.value_or(usual.plate_mu);
    contact.glued = usual.glued;
    return contact;
}

std::vector<FixtureSpec> between_platens(const MethodInput& in) {
    std::vector<FixtureSpec> fixtures = {platen(in, true), platen(in, false)};
    if (!is_confined(in.test)) return fixtures;
    if (in.model.kind == GrainKind::flexible) {
        FixtureSpec sides;
        sides.name = "sides";
        sides.kind = FixtureKind::pressure;
        sides.part.remaining = true;
        sides.pressure_Pa = in.test.sigma3_Pa;
        fixtures.push_back(sides);
    } else {
        fixtures.push_back(membrane(in, true));
        fixtures.push_back(membrane(in, false));
    }
    return fixtures;
}

double height_m(const MethodInput& in) {
    const Box box = bounding_box(in.specimen.mesh.nodes);
    return box.upper.y - box.lower.y;
}

double section_width_m(const Outline& outline, double loaded_width_m) {
    const double narrowest = section_widths(outline).narrowest;
    return narrowest > 0.0 && narrowest < (1.0 - 1e-9) * loaded_width_m ? narrowest : loaded_width_m;
}

double narrowest_section_m2(const MethodInput& in) {
    return section_width_m(in.specimen.outline, labelled_width_m(in.specimen, top_label)) * in.specimen.spec.thickness_m;
}

}  // namespace feldspar
