// Moment tensor of a crack by what its faces moved, and by the forces on the grains around it (docs/theory/properties.md, (P66), (P71)).
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/model/packs.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// A specimen in direct tension, elastic, per metre of platen travel; one of its contacts may be broken.
struct Pulled {
    std::vector<Mat2> moments;   // of each grain, sum of arm times force
    Vec2 jump;                   // across the contact, mean over its points
    Vec2 normal, place;
    double area_m2 = 0.0;
    int a = 0, b = 0;            // its grains
};

Pulled pull(const TestSetup& setup, int broken, bool breaks) {
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    Assembly& assembly = e.assembly;
    const Contact& contact = assembly.contacts[broken];
    if (breaks) {
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) assembly.bonds.damage[assembly.points[p].state] = 1.0;
        sort_out_packs(assembly);
    }
    prepare(e);
    Pulled pulled;
    pulled.moments.resize(setup.specimen->mesh.vertex_count.size());
    sum_grain_moments(assembly, setup.specimen->mesh, pulled.moments);
    const double per_travel = 1.0 / e.platen_travel_m;
    for (Mat2& m : pulled.moments) m = {per_travel * m.xx, per_travel * m.xy, per_travel * m.yx, per_travel * m.yy};
    pulled.normal = contact_frame(assembly, contact).n;
    for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
        const double area = assembly.points[p].area_m2;
        pulled.area_m2 += area;
        pulled.jump += (area * per_travel) * (assembly.bond(p).un_m * pulled.normal + assembly.bond(p).us_m * rot90(pulled.normal));
    }
    pulled.jump = (1.0 / pulled.area_m2) * pulled.jump;
    pulled.a = assembly.bodies[contact.a.body].grain;
    pulled.b = assembly.bodies[contact.b.body].grain;
    pulled.place = assembly.origins[broken].from;
    return pulled;
}

TEST(MomentTensor, ByForces) {
    TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.03, 0.06)), methods::direct_tension);
    const double G = setup.grain.E_Pa / (2.0 * (1.0 + setup.grain.nu)), lambda = 2.0 * G * setup.grain.nu / (1.0 - setup.grain.nu);
    int seen = 0;
    const RunControl control = fixtures::threads(1);
    const Experiment e(setup, control);
    for (int c = 0; c < static_cast<int>(e.assembly.contacts.size()) && seen < 20; c += 7) {
        const Contact& contact = e.assembly.contacts[c];
        if (contact.plate || e.assembly.origins[c].edge_a < 0 || e.assembly.origins[c].edge_b < 0) continue;
        const Pulled whole = pull(setup, c, false);
        if (whole.place.y < 0.015 || whole.place.y > 0.045 || whole.place.x < 0.007 || whole.place.x > 0.023) continue;
        const Pulled cracked = pull(setup, c, true);
        const Vec2 n = cracked.normal, d = cracked.jump;
        const double A = cracked.area_m2, opening = dot(d, n);
        const Mat2 M = {A * (lambda * opening + 2.0 * G * d.x * n.x), A * G * (d.x * n.y + d.y * n.x), A * G * (d.x * n.y + d.y * n.x), A * (lambda * opening + 2.0 * G * d.y * n.y)};
        Mat2 F{};
        for (const int g : {cracked.a, cracked.b}) {
            F.xx -= cracked.moments[g].xx - whole.moments[g].xx;
            F.xy -= cracked.moments[g].xy - whole.moments[g].xy;
            F.yy -= cracked.moments[g].yy - whole.moments[g].yy;
        }
        const auto scalar = [](const Mat2& m) { return std::sqrt(0.5 * (m.xx * m.xx + 2.0 * m.xy * m.xy + m.yy * m.yy)); };
        const auto R = [](const Mat2& m) {
            const double mean = 0.5 * (m.xx + m.yy), r = std::hypot(0.5 * (m.xx - m.yy), m.xy);
            return 100.0 * 2.0 * mean / (2.0 * std::abs(mean) + 2.0 * r);
        };
        const double along = (M.xx * F.xx + 2.0 * M.xy * F.xy + M.yy * F.yy) / (2.0 * scalar(M) * scalar(F));
        std::printf("contact %d n (%.2f %.2f) A %.3g jump ratio %.3f  M0 disp %.4g  M0 force %.4g ratio %.3f  cos %.3f  R %.0f %.0f\n", c, n.x, n.y, A, norm(whole.jump) / norm(d), scalar(M), scalar(F), scalar(F) / scalar(M), along, R(M), R(F));
        ++seen;
    }
}

}  // namespace
}  // namespace feldspar
