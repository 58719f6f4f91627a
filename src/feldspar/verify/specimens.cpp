// Whole elastic specimens: their moduli, their stress, the balance of what acts on them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "feldspar/lab/body_energy.hpp"
#include "feldspar/lab/elastic_start.hpp"
#include "feldspar/lab/grain_fields.hpp"
#include "feldspar/model/assemble.hpp"
#include "feldspar/verify/bodies.hpp"
#include "feldspar/verify/topics.hpp"

namespace feldspar {
namespace {

using namespace bodies;

std::vector<CheckedValue> constants_of_the_grains(bool ratio) {
    // A small specimen, whose staircase of contacts shortens nothing.
    static const auto row = [] {
        TestSetup s = setup(make(rectangle(0.03, 0.06)), methods::uniaxial_compression);
        s.numerics.maximum_steps = 10;
        s.contact.Kn_Pa_m *= 30.0;
        return run_test(s, {}).history.back();
    }();
    if (ratio) return {{"", 0.23, -row.lateral_strain_gauge / row.axial_strain_gauge}};
    return {{"", 25.8, 1e-9 * row.axial_stress_Pa / row.axial_strain}};
}

struct Mean {
    double bottom_over_top = 0.0, mean_over_platens = 0.0;
};

Mean mean_stress(const ModelSpec& of) {
    Started s(setup(rectangle(0.02, 0.04), methods::uniaxial_compression, of));
    Experiment& e = s.e;
    double sum = 0.0, volume = 0.0;
    if (!e.assembly.triangles.empty()) {
        for (const Triangle& t : e.assembly.triangles) {
            sum += t.volume_m3 *
                   cauchy_stress(e.assembly.elasticity.front(), displacement_gradient(e.assembly.nodes.displacement, t)).yy;
            volume += t.volume_m3;
        }
    } else {
        const std::vector<Mat2> stresses = grain_stresses(e.assembly, *s.setup.specimen);
        for (const Body& body : e.assembly.bodies) {
            if (body.grain < 0) continue;
            sum += body.volume_m3 * stresses[body.grain].yy;
            volume += body.volume_m3;
        }
    }
    const Reactions r = reactions(e.assembly);
    return {r.rest / r.loading, -sum / volume / e.stress(0.5 * (r.loading + r.rest))};
}

std::vector<ModelSpec> all_models() {
    std::vector<ModelSpec> models = rigid_models();
    models.insert(models.begin(), ModelSpec{});
    return models;
}

std::string words(const ModelSpec& m) {
    return std::string(name(m.kind)) + ", " + (m.kind == GrainKind::inner_particles ? name(m.normal) : name(m.contact));
}

const std::vector<Mean>& means() {
    static const std::vector<Mean> all = [] {
        std::vector<Mean> list;
        for (const ModelSpec& m : all_models()) list.push_back(mean_stress(m));
        return list;
    }();
    return all;
}

std::vector<CheckedValue> of_all_models(double Mean::*value) {
    std::vector<CheckedValue> compared;
    const std::vector<ModelSpec> models = all_models();
    for (std::size_t m = 0; m < models.size(); ++m) compared.push_back({words(models[m]), 1.0, means()[m].*value});
    return compared;
}

GaugeSpec mean_gauge(Vec2 direction, Vec2 normal = {}) {
    GaugeSpec gauge;
    gauge.name = "mean";
    gauge.kind = GaugeKind::mean_stress;
    gauge.region = {{-1.0, -1.0}, {1.0, 1.0}, 0.0};
    gauge.direction = direction;
    gauge.normal = normal;
    return gauge;
}

std::vector<ModelSpec> three_models() { return {ModelSpec{}, model(GrainKind::rigid), model(GrainKind::inner_particles)}; }

std::vector<CheckedValue> stress_tensor() {
    std::vector<CheckedValue> compared;
    for (const ModelSpec& m : three_models()) {
        Started s(setup(rectangle(0.03, 0.06), methods::uniaxial_compression, m));
        evaluate_forces(s.e.assembly, s.e.team, Strength::unlimited);
        const Vec2 x{1.0, 0.0}, y{0.0, 1.0}, slant = std::sqrt(0.5) * Vec2{1.0, 1.0}, across = std::sqrt(0.5) * Vec2{1.0, -1.0};
        const std::vector<double> read =
            Gauges(s.e.assembly, *s.setup.specimen,
                   {mean_gauge(y), mean_gauge(x), mean_gauge(x, y), mean_gauge(slant), mean_gauge(slant, across)})
                .read(s.e.assembly);
        const double load = s.e.stress(reactions(s.e.assembly).loading);
        const std::pair<const char*, double> parts[] = {
            {"along", 1.0}, {"across", 0.0}, {"shear", 0.0}, {"at 45 degrees", 0.5}, {"shear at 45 degrees", -0.5}};
        for (std::size_t i = 0; i < read.size(); ++i)
            compared.push_back({std::string(name(m.kind)) + ", " + parts[i].first, parts[i].second, read[i] / load});
    }
    return compared;
}

std::vector<CheckedValue> consolidation() {
    TestSetup s = setup(make(rectangle(0.02, 0.04)), methods::biaxial);
    s.test.sigma3_Pa = 10e6;
    s.numerics.maximum_steps = 50;
    std::vector<CheckedValue> compared;
    for (const NumericsKind kind : {NumericsKind::adaptive, NumericsKind::paper}) {
        s.numerics.kind = kind;
        const TestResult r = run_test(s, {});
        for (auto row = r.history.rbegin(); row != r.history.rend(); ++row)
            if (row->phase == Phase::consolidation) {
                compared.push_back({name(kind), 10.0, 1e-6 * row->axial_stress_Pa});
                break;
            }
    }
    return compared;
}

constexpr double kWidth = 0.03, kHeight = 0.02, kThickness = 0.08, kGravity = 9.81, kDensity = 2650.0, kMu = 0.4;

FixtureSpec plate(const char* name, const char* label, Vec2 normal, double mu = 0.0, Vec2 motion = {}) {
    FixtureSpec plate;
    plate.name = name;
    plate.kind = FixtureKind::plate;
    plate.part.label = label;
    plate.normal = plate.part.facing = normal;
    plate.motion = motion;
    plate.contact.mu = mu;
    return plate;
}

FixtureSpec pressed(FixtureSpec plate, double force_N, double spring_Pa_m = 0.0) {
    plate.pressed = true;
    plate.force_N = force_N;
    plate.spring_Pa_m = spring_Pa_m;
    return plate;
}

GaugeSpec of_fixture(GaugeKind kind, const char* fixture, Vec2 direction) {
    GaugeSpec gauge;
    gauge.name = fixture;
    gauge.kind = kind;
    gauge.fixture = fixture;
    gauge.direction = direction;
    return gauge;
}

TestSetup own_test(const ModelSpec& model, double height_m, std::vector<FixtureSpec> list, bool weighs) {
    TestSetup s = setup(rectangle(kWidth, height_m), methods::custom, model);
    s.test = usual_test(methods::custom);
    s.test.custom.name = "dead-loads";
    s.test.custom.fixtures = std::move(list);
    if (weighs) s.test.custom.gravity_m_s2 = {0.0, -kGravity};
    return s;
}

double weight_N(double height_m) { return kDensity * kGravity * kWidth * height_m * kThickness; }

struct Column {
    double on_table_N = 0.0, mean_Pa = 0.0, energy_over_work = 0.0;
};

constexpr double kColumn = 0.06;

Column column(const ModelSpec& m) {
    const TestSetup s = own_test(m, kColumn, {plate("table", "bottom", {0.0, -1.0}, kMu)}, true);
    const RunControl control;
    Experiment e(s, control);
    choose_step(e);
    e.set_dead_loads(1.0);
    relax(e.assembly, e.team, Strength::unlimited, 1e-6, 50000, nullptr);
    const StoredEnergy stored = stored_energy(e.assembly, 0.0);
    return {-felt_by(e.assembly, e.assembly.fixtures.front()).y,
            Gauges(e.assembly, *s.specimen, {mean_gauge({0.0, 1.0})}).read(e.assembly).front(),
            (stored.grains_J + stored.contacts_J) / e.weight_work()};
}

const std::array<Column, 3>& columns() {
    static const std::array<Column, 3> all = {column(three_models()[0]), column(three_models()[1]), column(three_models()[2])};
    return all;
}

std::vector<CheckedValue> of_columns(double expected, double factor, double Column::*value) {
    std::vector<CheckedValue> compared;
    for (std::size_t m = 0; m < 3; ++m)
        compared.push_back({name(three_models()[m].kind), expected, factor * (columns()[m].*value)});
    return compared;
}

// A block is pushed along a table by a plate behind it, under its own weight or under a plate with a given force.
std::vector<CheckedValue> sliding_block() {
    std::vector<CheckedValue> compared;
    for (const ModelSpec& m : three_models())
        for (const bool weighs : {true, false}) {
            if (!weighs && m.kind == GrainKind::inner_particles) continue;  // the costliest, and no other law
            std::vector<FixtureSpec> list{plate("table", "bottom", {0.0, -1.0}, kMu),
                                          plate("pusher", "left", {-1.0, 0.0}, 0.0, {1.0, 0.0})};
            const double normal_N = weighs ? weight_N(kHeight) : 20e3;
            if (!weighs) list.push_back(pressed(plate("lid", "top", {0.0, 1.0}), normal_N));
            TestSetup s = own_test(m, kHeight, std::move(list), weighs);
            s.test.custom.gauges = {of_fixture(GaugeKind::force, "table", {0.0, -1.0}),
                                    of_fixture(GaugeKind::force, "table", {1.0, 0.0})};
            s.test.maximum_strain = weighs ? 2e-5 : 2e-3;  // it slides from about a third of that on
            s.test.control = LoadControl::displacement;
            const TestResult r = run_test(s, {});
            const HistoryRow& end = r.history.back();
            const std::string what = std::string(name(m.kind)) + (weighs ? ", own weight" : ", lid");
            compared.push_back({what + ": normal force", 1.0, end.gauges[0] / normal_N});
            compared.push_back({what + ": friction", 1.0, end.gauges[1] / (kMu * normal_N)});
            compared.push_back({what + ": pushing force", 1.0, end.stress_top_Pa * r.section_m2 / (kMu * normal_N)});
        }
    return compared;
}

std::vector<CheckedValue> spring() {
    constexpr double force_N = 20e3, spring_Pa_m = 2e12;
    std::vector<CheckedValue> compared;
    for (const ModelSpec& m : {three_models()[0], three_models()[1]}) {
        // Pressed from the left, the specimen widens upwards against the lid.
        TestSetup s = own_test(m, kHeight,
                               {plate("table", "bottom", {0.0, -1.0}, kMu), plate("wall", "right", {1.0, 0.0}),
                                plate("pusher", "left", {-1.0, 0.0}, 0.0, {1.0, 0.0}),
                                pressed(plate("lid", "top", {0.0, 1.0}), force_N, spring_Pa_m)},
                               false);
        s.test.custom.gauges = {of_fixture(GaugeKind::force, "lid", {0.0, 1.0}),
                                of_fixture(GaugeKind::displacement, "lid", {0.0, 1.0})};
        s.test.maximum_stress_Pa = 30e6;
        const TestResult r = run_test(s, {});
        const HistoryRow &start = r.history[1], &end = r.history.back();
        compared.push_back({std::string(name(m.kind)) + ", at the start", 1e-3 * force_N, 1e-3 * start.gauges[0]});
        compared.push_back({std::string(name(m.kind)) + ", at the end",
                            1e-3 * (force_N + spring_Pa_m * kWidth * kThickness * (end.gauges[1] - start.gauges[1])),
                            1e-3 * end.gauges[0]});
    }
    return compared;
}

}  // namespace

std::vector<Check> specimen_checks() {
    return {
        {.name = "specimens.modulus",
         .sentence = "A specimen whose contacts are very stiff has the Young's modulus of its grains.",
         .formula = "1 / E = 1 / E_grain + 1 / (Kn d), Kn large",
         .source = "springs in series",
         .unit = "GPa",
         .bound = relative(5e-3),
         .reason = "30 times stiffer contacts, not infinitely stiff ones",
         .compare = [] { return constants_of_the_grains(false); },
         .run = "stiff-contacts"},
        {.name = "specimens.poisson",
         .sentence = "A specimen whose contacts are very stiff has the Poisson's ratio of its grains.",
         .formula = "nu = nu_grain",
         .source = "Hooke",
         .bound = absolute(5e-3),
         .reason = "30 times stiffer contacts, not infinitely stiff ones",
         .compare = [] { return constants_of_the_grains(true); },
         .run = "stiff-contacts"},
        {.name = "specimens.equilibrium",
         .sentence = "At the beginning of a test both platens bear the same load, for every kind of grain.",
         .formula = "R_bottom / R_top = 1",
         .source = "equilibrium",
         .bound = absolute(2e-3),
         .reason = "what the elastic start leaves moving",
         .compare = [] { return of_all_models(&Mean::bottom_over_top); },
         .run = "means"},
        {.name = "specimens.mean-stress-of-grains",
         .sentence = "The stress of the grains, averaged over the volume, is that of the platens.",
         .formula = "sum V sigma / sum V = R / A",
         .source = "mean stress of a body in equilibrium",
         .bound = absolute(1e-2),
         .reason = "what the elastic start leaves moving, and grains that touch the platens",
         .compare = [] { return of_all_models(&Mean::mean_over_platens); },
         .run = "means"},
        {.name = "specimens.stress-tensor",
         .sentence =
             "A gauge of the mean stress over the whole specimen reads the tensor of the load in every direction; over the load.",
         .formula = "n . sigma . m, sigma = (0, 0; 0, R / A)",
         .source = "(P41), (P42)",
         .bound = absolute(2e-3),
         .reason = "what the elastic start leaves moving",
         .compare = stress_tensor},
        {.name = "specimens.consolidation",
         .sentence = "Before a confined test is loaded its axial stress is the pressure on its sides.",
         .formula = "sigma_1 = sigma_3",
         .source = "(L1), (L2)",
         .unit = "MPa",
         .bound = relative(3e-3),
         .reason = "the servo's own tolerance is 2e-3",
         .compare = consolidation},
        {.name = "specimens.weight",
         .sentence = "A column under gravity presses on its table with its weight.",
         .formula = "F = rho g b h t",
         .source = "statics",
         .unit = "N",
         .bound = relative(1e-4),
         .reason = "what the relaxation leaves moving",
         .compare = [] { return of_columns(weight_N(kColumn), 1.0, &Column::on_table_N); },
         .run = "column"},
        {.name = "specimens.stress-of-a-column",
         .sentence = "The mean stress of a column under gravity is that at half its height.",
         .formula = "sigma = rho g h / 2",
         .source = "statics",
         .unit = "Pa",
         .bound = relative(1e-3),
         .reason = "what the relaxation leaves moving",
         .compare = [] { return of_columns(0.5 * kDensity * kGravity * kColumn, 1.0, &Column::mean_Pa); },
         .run = "column"},
        {.name = "specimens.energy-of-a-column",
         .sentence = "A column at rest has stored half of what gravity has done.",
         .formula = "U / W = 1 / 2",
         .source = "Clapeyron",
         .bound = relative(1e-3),
         .reason = "what the relaxation leaves moving",
         .compare = [] { return of_columns(0.5, 1.0, &Column::energy_over_work); },
         .run = "column"},
        {.name = "specimens.sliding-block",
         .sentence = "A block slides on a table at friction times its weight or the force of a lid; forces over these.",
         .formula = "T = mu N",
         .source = "Coulomb",
         .bound = relative(2e-3),
         .reason = "what still rings while it slides, 1e-3 of the normal force and of the friction",
         .compare = sliding_block},
        {.name = "specimens.lid-behind-a-spring",
         .sentence = "The force of a lid behind a spring grows with its way.",
         .formula = "F = F0 + k b t u",
         .source = "(L21)",
         .unit = "kN",
         .bound = relative(1e-3),
         .reason = "what still rings while it is loaded",
         .compare = spring},
    };
}

}  // namespace feldspar
