// Moment tensor of a crack by what its faces moved, and by the forces on the grains around it (docs/theory/properties.md, (P66),
// (P71)).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/model/packs.hpp"
#include "fixtures.hpp"

namespace feldspar {
namespace {

// A specimen in direct tension, elastic, per metre of platen travel; one of its contacts may be broken.
struct Pulled {
    std::vector<Mat2> moments;  // of each grain, sum of arm times force
    Vec2 jump;                  // across the contact, mean over its points
    Vec2 normal, place;
    double area_m2 = 0.0;
    int a = 0, b = 0;  // its grains
};

Pulled pull(const TestSetup& setup, int broken, bool breaks) {
    const RunControl control = fixtures::threads(1);
    Experiment e(setup, control);
    choose_step(e);
    Assembly& assembly = e.assembly;
    const Contact& contact = assembly.contacts[broken];
    if (breaks) {
        for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
            assembly.bonds.damage[assembly.points[p].state] = 1.0;
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
        pulled.jump +=
            (area * per_travel) * (assembly.bond(p).un_m * pulled.normal + assembly.bond(p).us_m * rot90(pulled.normal));
    }
    pulled.jump = (1.0 / pulled.area_m2) * pulled.jump;
    pulled.a = assembly.bodies[contact.a.body].grain;
    pulled.b = assembly.bodies[contact.b.body].grain;
    pulled.place = assembly.origins[broken].from;
    return pulled;
}

double scalar(const Mat2& m) { return std::sqrt(0.5 * (m.xx * m.xx + 2.0 * m.xy * m.xy + m.yy * m.yy)); }

// (P68)
double isotropy(const Mat2& m) {
    const double mean = 0.5 * (m.xx + m.yy), radius = std::hypot(0.5 * (m.xx - m.yy), m.xy);
    return 100.0 * 2.0 * mean / (2.0 * std::abs(mean) + 2.0 * radius);
}

// A contact that breaks in an elastic body: the stress that its grains lose has the directions and the R of the displacements'
// tensor, and is smaller by what the surroundings give way, which is a quarter of it or so: of rigid surroundings nothing, of
// none at all everything.
TEST(MomentTensor, ByContactForcesIsThatByDisplacementsLessWhatTheSurroundingsGiveWay) {
    const TestSetup setup = fixtures::setup(fixtures::make(fixtures::rectangle(0.03, 0.06)), methods::direct_tension);
    const double G = setup.grain.E_Pa / (2.0 * (1.0 + setup.grain.nu)),
                 lambda = 2.0 * G * setup.grain.nu / (1.0 - setup.grain.nu);  // plane stress
    const RunControl control = fixtures::threads(1);
    const Experiment e(setup, control);
    int seen = 0;
    double mean_ratio = 0.0;
    for (int c = 0; c < static_cast<int>(e.assembly.contacts.size()) && seen < 10; c += 7) {
        const Contact& contact = e.assembly.contacts[c];
        const Vec2 place = e.assembly.origins[c].from;
        if (contact.plate || std::abs(place.x - 0.015) > 0.008 || std::abs(place.y - 0.03) > 0.015)
            continue;                                                          // away from the edges
        if (std::abs(contact_frame(e.assembly, contact).n.y) < 0.7) continue;  // those that the load opens
        const Pulled whole = pull(setup, c, false), cracked = pull(setup, c, true);
        const Vec2 n = cracked.normal, d = cracked.jump;
        const double A = cracked.area_m2, opening = dot(d, n), shear = A * G * (d.x * n.y + d.y * n.x);
        const Mat2 moved{A * (lambda * opening + 2.0 * G * d.x * n.x), shear, shear,
                         A * (lambda * opening + 2.0 * G * d.y * n.y)};
        Mat2 lost{};  // the contact between the two grains cancels in their sum
        for (const int g : {cracked.a, cracked.b}) {
            lost.xx += whole.moments[g].xx - cracked.moments[g].xx;
            lost.xy += whole.moments[g].xy - cracked.moments[g].xy;
            lost.yy += whole.moments[g].yy - cracked.moments[g].yy;
        }
        const double along = (moved.xx * lost.xx + 2.0 * moved.xy * lost.xy + moved.yy * lost.yy) /
                             (2.0 * scalar(moved) * scalar(lost)),
                     ratio = scalar(lost) / scalar(moved);
        EXPECT_GT(along, 0.98) << "contact " << c;
        EXPECT_NEAR(isotropy(lost), isotropy(moved), 6.0) << "contact " << c;
        EXPECT_GT(ratio, 0.5) << "contact " << c;
        EXPECT_LT(ratio, 0.95) << "contact " << c;
        mean_ratio += ratio;
        ++seen;
    }
    ASSERT_EQ(seen, 10);
    EXPECT_NEAR(mean_ratio / seen, 0.75, 0.05);  // measured
}

}  // namespace
}  // namespace feldspar
