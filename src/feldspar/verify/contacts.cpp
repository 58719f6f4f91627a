// How contacts move, what they conserve, and what presses on a body.
#include <algorithm>
#include <cmath>

#include "feldspar/base/rng.hpp"
#include "feldspar/lab/body_energy.hpp"
#include "feldspar/laws/damping.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/model/attachment.hpp"
#include "feldspar/model/masses.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

constexpr double kSide = 0.003, kArea = kSide * 0.08;

Assembly small_body(ContactKind kind = ContactKind::lobatto3) {
    ModelSpec model;
    model.contact = kind;
    return assemble(*make(rectangle(0.02, 0.04)), model, granite(), table7());
}

IndexRange all_contacts(const Assembly& assembly) { return {0, static_cast<int>(assembly.contacts.size())}; }

std::vector<CheckedValue> rotation_in_steps() {
    Assembly assembly = small_body();
    constexpr int kSteps = 1000;
    for (int k = 1; k <= kSteps; ++k) {
        for (int n = 0; n < assembly.nodes.count(); ++n) {
            const Vec2 X = assembly.nodes.reference[n], after = turned(X, 0.3 * k / kSteps) - X;
            assembly.nodes.velocity[n] = after - assembly.nodes.displacement[n];
            assembly.nodes.displacement[n] = after;
        }
        contact_forces(assembly, all_contacts(assembly), StepSettings{}, k);
    }
    double un = 0.0, us = 0.0;
    for (int p = 0; p < std::ssize(assembly.points); ++p) {
        un = std::max(un, std::abs(assembly.bond(p).un_m));
        us = std::max(us, std::abs(assembly.bond(p).us_m));
    }
    return {{"largest opening", 0.0, 1e9 * un}, {"largest sliding", 0.0, 1e9 * us}};
}

// Opening and sliding of all points when one side moves along the line of centres, and across it: the values farthest off.
std::vector<CheckedValue> directions() {
    Assembly assembly = small_body();
    constexpr double kBy = 1e-9;
    double worst[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int c = 0; c < static_cast<int>(assembly.contacts.size()); ++c) {
        const Contact& contact = assembly.contacts[c];
        const Vec2 line = assembly.centre(contact.b.body) - assembly.centre(contact.a.body), n = (1.0 / norm(line)) * line;
        for (const bool shear : {false, true}) {
            std::fill(assembly.nodes.velocity.begin(), assembly.nodes.velocity.end(), Vec2{});
            for (const int i : assembly.bodies[contact.b.body].nodes()) assembly.nodes.velocity[i] = kBy * (shear ? rot90(n) : n);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) assembly.set_bond(p, {});
            contact_forces(assembly, {c, c + 1}, StepSettings{}, 0);
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) {
                const double seen[2] = {assembly.bond(p).un_m / kBy, assembly.bond(p).us_m / kBy};
                for (int i = 0; i < 2; ++i) {
                    const double expected = (i == 1) == shear ? 1.0 : 0.0;
                    double& w = worst[shear ? 1 : 0][i];
                    if (std::abs(seen[i] - expected) > std::abs(w - expected)) w = seen[i];
                }
            }
        }
    }
    return {{"along: opening", 1.0, worst[0][0]},
            {"along: sliding", 0.0, worst[0][1]},
            {"across: opening", 0.0, worst[1][0]},
            {"across: sliding", 1.0, worst[1][1]}};
}

std::vector<CheckedValue> lobatto_moments() {
    const Assembly assembly = small_body();
    double worst[4] = {1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0}, off = 0.0;
    for (const Contact& contact : assembly.contacts) {
        const Vec2 p0 = assembly.nodes.reference[contact.a.node[0]], p1 = assembly.nodes.reference[contact.a.node[1]];
        const double length = norm(p1 - p0), area = length * assembly.thickness_m;
        const ContactFrame frame = contact_frame(assembly, contact);
        double moments[4] = {0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i < contact.points; ++i) {
            const ContactPoint& point = assembly.points[contact.first_point + i];
            const Vec2 x = frame.reference_point + point.along_m * frame.edge_tangent;
            off = std::max(off, norm(x - (p0 + (0.5 * i) * (p1 - p0))) / length);
            for (int power = 0; power < 4; ++power)
                moments[power] += point.area_m2 / area * std::pow(norm(x - p0) / length, power);
        }
        for (int power = 0; power < 4; ++power)
            if (std::abs(moments[power] - 1.0 / (power + 1)) > std::abs(worst[power] - 1.0 / (power + 1)))
                worst[power] = moments[power];
    }
    std::vector<CheckedValue> compared{{"distance from ends and middle, over the edge", 0.0, off}};
    for (int power = 0; power < 4; ++power)
        compared.push_back({"mean of x^" + std::to_string(power), 1.0 / (power + 1), worst[power]});
    return compared;
}

std::vector<CheckedValue> depth_of_one_point() {
    Assembly assembly = small_body(ContactKind::point);
    const int bonded = static_cast<int>(assembly.contacts.size());
    for (int c = 0; c < bonded; ++c)
        add_new_contact(assembly, assembly.contacts[c].a.body, assembly.contacts[c].b.body, 0.0, 0.0);
    double worst = 0.0;
    for (const Contact& contact : assembly.contacts) {
        const ContactFrame frame = contact_frame(assembly, contact);
        const Vec2 x = frame.reference_point + assembly.points[contact.first_point].along_m * frame.edge_tangent;
        const double in_a = assembly.bodies[contact.a.body].radius_m - norm(x - assembly.centre(contact.a.body)),
                     in_b = assembly.bodies[contact.b.body].radius_m - norm(x - assembly.centre(contact.b.body));
        worst = std::max(worst, std::abs(in_a - in_b));
    }
    return {{"", 0.0, 1e9 * worst}};
}

// Sum of the forces on both sides of each contact, and of their moments, over their sizes: the largest of all contacts.
std::vector<CheckedValue> momentum() {
    Assembly assembly = small_body();
    RandomStream random(7, "momentum");
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        const Vec2 strain = {1e-4 * random.normal(), 1e-4 * random.normal()};  // large enough that shapes are extrapolated
        assembly.nodes.displacement[n] = turned(X, 0.1) - X + 1e-3 * strain;
        assembly.nodes.velocity[n] = {1e-9 * random.normal(), 1e-9 * random.normal()};
    }
    contact_forces(assembly, all_contacts(assembly), StepSettings{}, 0);
    double linear = 0.0, angular = 0.0;
    for (std::size_t c = 0; c < assembly.contacts.size(); ++c) {
        const Contact& contact = assembly.contacts[c];
        const auto on_corners = [&](const ContactSide& side, const SlotForces& slot) {
            return forces_on_corners(corners(assembly.nodes, side.node), assembly.centre(side.body), slot);
        };
        const auto on_a = on_corners(contact.a, assembly.slots[2 * c]), on_b = on_corners(contact.b, assembly.slots[2 * c + 1]);
        Vec2 sum;
        double moment = 0.0, size = 0.0;
        for (int i = 0; i < 3; ++i) {
            sum += on_a[i] + on_b[i];
            moment += cross(assembly.nodes.position(contact.a.node[i]), on_a[i]) +
                      cross(assembly.nodes.position(contact.b.node[i]), on_b[i]);
            size += norm(on_a[i]) + norm(on_b[i]);
        }
        linear = std::max(linear, norm(sum) / size);
        angular = std::max(angular, std::abs(moment) / (size * 0.04));
    }
    return {{"force", 0.0, linear}, {"moment, arm of the body's height", 0.0, angular}};
}

// Largest departure of forces and moments from those turned by 0.3 rad, over their sizes.
std::vector<CheckedValue> turned_forces() {
    Assembly assembly = small_body();
    RandomStream random(9, "turned forces");
    for (int n = 0; n < assembly.nodes.count(); ++n)
        assembly.nodes.displacement[n] = assembly.nodes.velocity[n] = {1e-9 * random.normal(), 1e-9 * random.normal()};
    contact_forces(assembly, all_contacts(assembly), StepSettings{}, 0);
    const std::vector<SlotForces> before = assembly.slots;
    const Array<Vec2> strained = assembly.nodes.displacement;
    constexpr int kSteps = 100;
    for (int k = 1; k <= kSteps; ++k) {
        for (int n = 0; n < assembly.nodes.count(); ++n) {
            const Vec2 X = assembly.nodes.reference[n], after = turned(X + strained[n], 0.3 * k / kSteps) - X;
            assembly.nodes.velocity[n] = after - assembly.nodes.displacement[n];
            assembly.nodes.displacement[n] = after;
        }
        contact_forces(assembly, all_contacts(assembly), StepSettings{}, k);
    }
    double force = 0.0, moment = 0.0;
    for (std::size_t slot = 0; slot < 2 * assembly.contacts.size(); ++slot) {
        const Mat2 M = before[slot].moment, now = assembly.slots[slot].moment;
        force = std::max(force, norm(assembly.slots[slot].force - turned(before[slot].force, 0.3)) / norm(before[slot].force));
        const double size = std::abs(M.xx) + std::abs(M.xy) + std::abs(M.yx) + std::abs(M.yy);
        for (const Vec2 direction : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}})  // R M R^T
            moment = std::max(moment, norm(now * turned(direction, 0.3) - turned(M * direction, 0.3)) / size);
    }
    return {{"force", 0.0, force}, {"moment", 0.0, moment}};
}

// Moment about the middle of the edge between two square grains when the upper one turns about it by a small angle, over
// Kn t L^3 / 12 times the angle.
double bending_moment(const ModelSpec& model) {
    constexpr double kAngle = 1e-9;
    const ContactMaterial contact = material(model);
    Assembly assembly = assemble(*two_grain_bar(kSide), model, granite(), contact);
    const Vec2 middle = {0.5 * kSide, kSide};
    const Body& upper = assembly.bodies[1];
    for (const int n : upper.nodes()) {
        Vec2& u = assembly.nodes.displacement[n];
        u = kAngle * rot90(assembly.nodes.reference[n] - middle);
        if (upper.kind == BodyKind::rigid && n > upper.centre_node) u = {kAngle * upper.radius_m, 0.0};
    }
    assembly.nodes.velocity = assembly.nodes.displacement;
    contact_forces(assembly, {0, 1}, StepSettings{}, 0);
    const SlotForces& on_upper = assembly.slots[1];
    const double moment = cross(assembly.centre(1) - middle, on_upper.force) + turning_moment(on_upper);
    return -moment / (contact.Kn_Pa_m * assembly.thickness_m * kSide * kSide * kSide / 12.0 * kAngle);
}

std::vector<CheckedValue> bending_moments() {
    std::vector<CheckedValue> compared;
    for (const GrainKind grains : {GrainKind::rigid, GrainKind::flexible}) {
        compared.push_back({std::string(name(grains)) + ", three points", 1.0, bending_moment(model(grains))});
        compared.push_back({std::string(name(grains)) + ", one point", 0.0, bending_moment(model(grains, ContactKind::point))});
    }
    return compared;
}

// The pressure on the sides of a body that is turned by 0.2 and stretched by 1.1.
std::vector<CheckedValue> pressure_on_faces() {
    const auto specimen = make(rectangle(0.02, 0.04));
    Assembly assembly = assemble(*specimen, ModelSpec{}, granite(), table7());
    constexpr double pressure = 5e6;
    attach(assembly, *specimen, platen_rows(*specimen, pressure));
    const double c = 1.1 * std::cos(0.2), s = 1.1 * std::sin(0.2);
    for (int n = 0; n < assembly.nodes.count(); ++n) {
        const Vec2 X = assembly.nodes.reference[n];
        assembly.nodes.displacement[n] = Vec2{c * X.x - s * X.y, s * X.x + c * X.y} - X;
    }
    Team team(1);
    evaluate_forces(assembly, team, Strength::unlimited);
    const Array<Vec2> without = assembly.nodes.force;
    assembly.dead_loads.front().pressure_Pa = pressure;
    evaluate_forces(assembly, team, Strength::unlimited);
    Vec2 on_left, on_right;
    for (int n = 0; n < assembly.nodes.count(); ++n)
        (assembly.nodes.reference[n].x < 0.01 ? on_left : on_right) += assembly.nodes.force[n] - without[n];
    const double expected = 1e-3 * pressure * 1.1 * 0.04 * assembly.thickness_m;  // both sides are 0.04 m high
    return {{"left side", expected, 1e-3 * on_left.x},
            {"right side", -expected, 1e-3 * on_right.x},
            {"left side, along it", 0.0, 1e-3 * on_left.y},
            {"right side, along it", 0.0, 1e-3 * on_right.y}};
}

struct PlateForce {
    double pressed_N = 0.0, dragged_N = 0.0;  // on the grain: away from the plate, against the grain's motion along it
};

constexpr double kKn = 1.08e13, kEta = 0.3;

// The upper of two rigid grains moves by `towards_m` towards the top plate, then by `along_m` along it.
PlateForce push(const PlateContact& plates, double towards_m, double along_m) {
    const auto specimen = two_grain_bar(kSide);
    Assembly assembly = assemble(*specimen, model(GrainKind::rigid), granite(), table1(GrainKind::rigid));
    attach(assembly, *specimen, end_plates(plates));
    const int top = assembly.fixtures[0].plate, centre = assembly.bodies[1].centre_node;
    const auto at =
        std::find_if(assembly.contacts.begin(), assembly.contacts.end(), [&](const Contact& c) { return c.b.body == top; });
    const int c = static_cast<int>(at - assembly.contacts.begin());
    for (const Vec2 move : {Vec2{0.0, towards_m}, Vec2{along_m, 0.0}}) {
        assembly.nodes.velocity[centre] = move;
        assembly.nodes.displacement[centre] += move;
        contact_forces(assembly, {c, c + 1}, StepSettings{}, 0);
    }
    return {-assembly.slots[2 * c].force.y, -assembly.slots[2 * c].force.x};
}

std::vector<CheckedValue> plates() {
    constexpr double towards = 1e-9, kn = kKn * kArea, Fn = kn * towards, mu = 0.25;
    const PlateForce stuck = push({kKn, kEta, mu, false}, towards, 1e-10), sliding = push({kKn, kEta, mu, false}, towards, 2e-9),
                     open = push({kKn, kEta, mu, false}, -1e-7, 1e-9), glued = push({kKn, kEta, 0.0, true}, -1e-3, 1e-9);
    return {{"pressed", Fn, stuck.pressed_N},
            {"sheared, it sticks", kEta * kn * 1e-10, stuck.dragged_N},
            {"sheared, it slides", mu * Fn, sliding.dragged_N},
            {"pulled", 0.0, open.pressed_N},
            {"pulled by 1 mm, glued, over a million", -1e-6 * kn * 1e-3, 1e-6 * glued.pressed_N}};
}

std::vector<CheckedValue> new_contact() {
    constexpr double kSkin = 3e-4;
    Assembly assembly =
        assemble(*two_grain_bar(kSide, 0.8 * kSide), model(GrainKind::rigid), granite(), table1(GrainKind::rigid));
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    ContactFinder finder(assembly, kSkin);
    std::fill(assembly.bonds.damage.begin(), assembly.bonds.damage.end(), 1.0);
    const int upper = assembly.bodies[1].centre_node;
    assembly.nodes.displacement[upper] = {0.0, 1.5 * kSkin};
    finder.update(assembly, 1.0);
    // Now beside the lower grain, radii 0.5 and 0.4 kSide: its side is kSide long, that of the upper one 0.8 of it.
    assembly.nodes.displacement[upper] =
        assembly.nodes.reference[0] + Vec2{0.9 * kSide - 1e-8, 0.0} - assembly.nodes.reference[upper];
    finder.update(assembly, 1.0);
    Team team(1);
    evaluate_forces(assembly, team, Strength::real);
    const int state = assembly.points.back().state;
    const double Fn = assembly.bonds.at(state).Fn_N;
    assembly.nodes.velocity[upper] = {0.0, 1e-6};  // slides along
    contact_forces(assembly, {1, 2}, StepSettings{}, 0);
    const double expected = kKn * 0.8 * kArea * 1e-8;
    return {{"pressure", expected, Fn}, {"friction", 0.5 * expected, std::abs(assembly.bonds.at(state).Fs_N)}};
}

std::vector<CheckedValue> masses_of_squares() {
    constexpr double h = kSide, mass = 2650.0 * h * h * 0.08;
    Assembly assembly = assemble(*two_grain_bar(h, 0.5 * h), model(GrainKind::rigid), granite(), table1(GrainKind::rigid));
    set_real_masses(assembly);
    return {{"mass, g", 1e3 * mass, 1e3 * assembly.nodes.mass[0]},
            {"inertia of the square, g mm2", 1e9 * mass * h * h / 6.0, 1e9 * assembly.nodes.mass[1] * 0.25 * h * h},
            {"inertia of the half square, g mm2", 1e9 * 0.5 * mass * 1.25 * h * h / 12.0,
             1e9 * assembly.nodes.mass[3] * h * h / 16.0}};
}

// The turn moves a point by its arc, the centre by its chord: of first order in the step, along the line of centres. Across it
// the line turns with the bodies, and what is left is of second order; across the edge's normal it is of first order too.
std::vector<CheckedValue> order_of_rigid_rotation() {
    std::vector<CheckedValue> compared;
    for (const ModelSpec& m : rigid_models()) {
        const bool inner = m.kind == GrainKind::inner_particles;  // ten times as many bodies: a smaller specimen
        const Assembly start =
            assemble(*make(filled_for(m, inner ? rectangle(0.014, 0.028) : rectangle(0.02, 0.04))), m, granite(), material(m));
        const Vec2 coarse = gaps_of_a_rotation(start, 1000), fine = gaps_of_a_rotation(start, 2000);
        const std::string what = std::string(name(m.kind)) + ", " + (inner ? name(m.normal) : name(m.contact));
        compared.push_back({what + ": opening", 1.0, std::log2(coarse.x / fine.x)});
        compared.push_back({what + ": sliding", m.normal == ContactNormal::centres ? 2.0 : 1.0, std::log2(coarse.y / fine.y)});
    }
    return compared;
}

std::vector<CheckedValue> viscous_damping() {
    Assembly assembly = small_body();
    set_scaled_masses(assembly, MassBound::tensor, 1.0);
    Team team(1);
    StepSettings settings;
    settings.viscous = 0.1;
    const Vec2 velocity = {0.5e-9, -1e-9};
    PlatenWork none;
    // A translation makes no forces, so that nothing but the damping acts.
    for (Vec2& V : assembly.nodes.velocity) V = velocity;
    StepSettings unstepped = settings;
    unstepped.dt = 0.0;
    const double before = motion(assembly, unstepped).kinetic_J, left = std::pow(0.95 / 1.05, 10);
    advance(assembly, team, settings, 0, 10, none);
    double farthest = left;
    for (const Vec2 V : assembly.nodes.velocity)
        if (const double share = dot(V, velocity) / dot(velocity, velocity); std::abs(share - left) > std::abs(farthest - left))
            farthest = share;
    return {{"velocity left", left, farthest},
            {"energy booked", 1.0 - left * left, stored_energy(assembly, 0.0).damping_J / before}};
}

std::vector<CheckedValue> local_damping() {
    constexpr double alpha = 0.7, loading = 2e-9, F = 30.0;
    return {{"as the loading moves", 0.0, local_drag(loading, loading, F, alpha)},
            {"twice as fast", alpha * F, local_drag(2.0 * loading, loading, F, alpha)},
            {"half as fast", 0.0, local_drag(0.5 * loading, loading, F, alpha)},
            {"against it", -alpha * F, local_drag(-0.5 * loading, loading, F, alpha)},
            {"without a loading motion", alpha * F, local_drag(loading, 0.0, F, alpha)}};
}

}  // namespace

std::vector<Check> contact_checks() {
    return {
        {.name = "contacts.directions",
         .sentence = "Contacts open along the line from centre to centre and slide across it; over the motion, the point that is "
                     "farthest off.",
         .formula = "dun = n . dv dt, dus = rot90(n) . dv dt",
         .source = "(C1), (C5)",
         .bound = absolute(1e-12),
         .reason = "shape functions sum to 1 to rounding",
         .compare = directions},
        {.name = "contacts.lobatto",
         .sentence = "The three points of an edge lie at its ends and its middle, and their areas integrate cubics exactly; the "
                     "edge that is farthest off.",
         .formula = "sum A x^k / A = 1 / (k + 1), k = 0 ... 3",
         .source = "(C2), (C3); Lobatto's rule",
         .bound = absolute(1e-9),
         .reason = "rounding of positions of 0.04 m over the shortest edge",
         .compare = lobatto_moments},
        {.name = "contacts.one-point",
         .sentence = "The single point of a contact, bonded or new, lies as deep in one grain's circle as in the other's.",
         .formula = "RA - s = RB - (d - s)",
         .source = "(C2)",
         .unit = "nm",
         .bound = absolute(1e-5),
         .reason = "rounding of positions of 0.04 m",
         .compare = depth_of_one_point},
        {.name = "contacts.rotation-opens-nothing",
         .sentence = "A specimen that turns by 0.3 rad in 1000 steps opens none of its contacts.",
         .formula = "un = us = 0",
         .source = "(C5)",
         .unit = "nm",
         .bound = absolute(1e-6),
         .reason = "rounding",
         .compare = rotation_in_steps},
        {.name = "contacts.rotation-turns-the-forces",
         .sentence = "The forces and moments of loaded contacts turn with the body; largest departure over their size.",
         .formula = "F -> R F, M -> R M R^T",
         .source = "(C5), (C20)",
         .bound = absolute(1e-6),
         .reason = "gaps of 1 nm are known to 1e-17 m a step, so forces to about 1e-7",
         .compare = turned_forces},
        {.name = "contacts.momentum",
         .sentence = "What a contact gives to one grain it takes from the other, force and moment; largest sum over the size.",
         .formula = "sum F = 0, sum x x F = 0",
         .source = "(C6), (C20)",
         .bound = absolute(1e-11),
         .reason = "rounding of sums over three corners",
         .compare = momentum},
        {.name = "contacts.order-of-rigid-rotation",
         .sentence = "Turning rigid grains opens contacts by an error of the first order in the step and slides them by one of "
                     "the second.",
         .formula = "log2(error(1000 steps) / error(2000 steps))",
         .source = "docs/theory/particle-models.md",
         .bound = absolute(0.015),
         .reason = "terms of the next order",
         .compare = order_of_rigid_rotation},
        {.name = "contacts.bending-moment",
         .sentence = "Three points on an edge carry the moment of a continuous bond, one point carries none; over Kn t L^3 / 12 "
                     "times the angle.",
         .formula = "M = Kn t L^3 / 12 phi",
         .source = "(C3), (C7)",
         .bound = absolute(1e-6),
         .reason = "gaps of 1e-12 m leave the angle's square and rounding",
         .compare = bending_moments},
        {.name = "contacts.new-contact",
         .sentence = "Two broken grains that meet again press by their overlap on the shorter edge, and rub.",
         .formula = "Fn = Kn t min(l) (RA + RB - d), |Fs| = mu Fn",
         .source = "(C17), (C13)",
         .unit = "N",
         .bound = relative(1e-6),
         .reason = "an overlap of 1e-8 m is known to 1e-15 m",
         .compare = new_contact},
        {.name = "contacts.plates",
         .sentence = "A plate presses by its stiffness, drags up to its friction, and lets go in tension unless it is glued.",
         .formula = "Fn = Kn A u, |Fs| = min(eta Kn A us, mu Fn)",
         .source = "(C19)",
         .unit = "N",
         .bound = absolute(1e-8),
         .reason = "rounding of some N",
         .compare = plates},
        {.name = "contacts.pressure",
         .sentence =
             "A pressure acts normal to the initial faces over their current length, on a body that is turned and stretched.",
         .formula = "F = p l t",
         .source = "(L1)",
         .unit = "kN",
         .bound = absolute(2e-8),
         .reason = "the stretch's own forces, some 1e5 N a node, leave their rounding",
         .compare = pressure_on_faces},
        {.name = "contacts.masses",
         .sentence = "Rigid rectangles have the mass and the moment of inertia of rectangles.",
         .formula = "m = rho b h t, I = m (b^2 + h^2) / 12",
         .source = "mechanics of rigid bodies",
         .bound = relative(1e-12),
         .reason = "rounding",
         .compare = masses_of_squares},
        {.name = "contacts.viscous-damping",
         .sentence = "Viscous damping takes the same share of the velocity at every step, and books the energy that it takes.",
         .formula = "v = v0 ((1 - c / 2) / (1 + c / 2))^n",
         .source = "docs/theory/motion-and-mass.md",
         .bound = absolute(1e-6),
         .reason = "rounding of the shape functions",
         .compare = viscous_damping},
        {.name = "contacts.local-damping",
         .sentence = "Local damping brakes what departs from the loading motion, and leaves the loading motion alone.",
         .formula = "drag = alpha |F| sign(V - L) where (V - L) V > 0, else 0",
         .source = "(M3)",
         .unit = "N",
         .bound = absolute(1e-12),
         .reason = "rounding of 21 N",
         .compare = local_damping},
    };
}

}  // namespace feldspar
