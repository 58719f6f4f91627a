#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

constexpr long long largest_seed = std::numeric_limits<long long>::max();

// Of a confined specimen's width, as a share of the narrowest: the pressure on sloping sides then adds at most this share of sigma3 to the
// axial stress.
constexpr double most_confined_taper = 0.1;

bool has_label(const OutlineSpec& outline, std::string_view label) {
    return std::find(outline.edge_labels.begin(), outline.edge_labels.end(), label) != outline.edge_labels.end();
}

// What a test is held against, as far as it was read without a mistake.
struct Known {
    bool outline = true;
    bool grain_sizes = true;
    bool kinds = true;   // of the grains of all variants
};

// Platens need a flat top and bottom.
void check_outline(const TableReader& table, TestKind kind, const OutlineSpec& outline) {
    if (method_of(kind).specimen.own_disc) {
        if ((outline.shape == Shape::disc || outline.shape == Shape::ring) && outline.is_cut())
            table.fail("kind", "'" + std::string(name(kind)) + "' cuts its own whole disc: the holes and notches of the specimen would not be in it", "a disc without holes and notches");
        return;
    }
    if (method_of(kind).specimen.confined && outline.is_cut())
        table.fail("kind", "'" + std::string(name(kind)) + "' presses on every side, those of holes and notches too", "a specimen without holes and notches");
    if (outline.shape == Shape::rectangle) return;
    if (outline.shape == Shape::polygon && has_label(outline, "top") && has_label(outline, "bottom")) {
        const SectionWidths widths = section_widths(make_outline(outline));
        if (method_of(kind).specimen.confined && widths.widest > (1.0 + most_confined_taper) * widths.narrowest)
            table.fail("kind",
                       fmt::format("'{}' presses on the sides too, which would load a specimen whose width varies from {:.4g} to {:.4g} mm along "
                                   "its axis as well", name(kind), 1000.0 * widths.narrowest, 1000.0 * widths.widest),
                       "a rectangle, or a polygon whose width varies by a tenth at most");
        return;
    }
    const std::string shape = outline.shape == Shape::disc ? "a disc" : outline.shape == Shape::half_disc ? "a half disc" : outline.shape == Shape::ring ? "a ring" : "a polygon without edges labelled \"top\" and \"bottom\"";
    table.fail("kind", "'" + std::string(name(kind)) + "' presses on flat ends, which " + shape + " has not",
               "shape = \"rectangle\", or a polygon with edges labelled \"top\" and \"bottom\"");
}

// The Brazilian test makes its own disc, of the specimen's width unless the test says otherwise.
double brazilian_diameter(const TableReader& table, const SpecimenSpec& specimen, const Known& known) {
    if (!known.outline) table.do_not_miss({"diameter"});
    if (!table.has("diameter") && specimen.outline.shape == Shape::polygon)
        table.check({"diameter"}, [&] { table.fail("diameter", "missing key: diameter (a polygon does not say how large the disc is to be)"); });
    const double usual = specimen.outline.shape == Shape::rectangle ? specimen.outline.width_m : specimen.outline.diameter_m;
    const double diameter = table.quantity("diameter", Dimension::length, positive, usual);
    if (!known.grain_sizes) return diameter;
    table.check({"diameter"}, [&] {
        const double largest = largest_diameter_m(specimen.grain_sizes);
        if (largest > 0.5 * diameter)
            table.fail("diameter",
                       "grains of up to " + format_exact(1000.0 * largest) + " mm do not fit a disc of " +
                           format_exact(1000.0 * diameter) + " mm",
                       "a disc of at least twice the largest grain");
    });
    return diameter;
}

// Angles that (P31) was computed for, and that laboratories use.
const Range flat_angle_range{10.0 * std::numbers::pi / 180.0, 40.0 * std::numbers::pi / 180.0, true, true, "from 10 to 40 degrees (20 to 30 are usual)"};
constexpr double usual_flat_angle_rad = 20.0 * std::numbers::pi / 180.0;

// The disc may be whole, or have two flats, on which flat plates press.
bool is_flattened(const TableReader& table) {
    return table.has("disc") && table.choice<bool>("disc", {{"whole", false}, {"flattened", true}});
}

// Angle over which a flat is seen from the centre; 0: of a whole disc.
double read_flats(const TableReader& table, bool flattened, const SpecimenSpec& specimen, double diameter_m, const Known& known, const TestSpec& test) {
    if (!flattened) {
        if (table.sound({"disc"})) table.refuse({"flat_angle"}, "a whole disc", "disc = \"flattened\"");
        return 0.0;
    }
    table.check({"plates", "disc"}, [&] {
        if (test.plates == PlateShape::curved) table.fail("plates", "curved jaws do not fit the flats of a flattened disc", "plates = \"flat\", or disc = \"whole\"");
    });
    const double angle_rad = table.quantity("flat_angle", Dimension::angle, flat_angle_range, usual_flat_angle_rad);
    const double width_m = diameter_m * std::sin(0.5 * angle_rad), largest_m = largest_diameter_m(specimen.grain_sizes);
    table.check({"flat_angle", "disc", "diameter"}, [&] {
        if (known.outline && known.grain_sizes && width_m < largest_m)
            table.fail(table.has("flat_angle") ? "flat_angle" : "disc",
                       fmt::format("the flats would be {:.3g} mm wide, less than the largest grain of {:.3g} mm", 1e3 * width_m, 1e3 * largest_m),
                       "flats wider than the largest grain: a larger angle, a larger disc, or smaller grains");
    });
    return angle_rad;
}

std::vector<double> confining_stresses(const TableReader& table) {
    const toml::array* list = table.find("sigma3") == nullptr ? nullptr : table.find("sigma3")->as_array();
    const Range range{0.0, std::numeric_limits<double>::infinity(), false, true,
                      "greater than zero (for zero: kind = \"uniaxial-compression\")"};
    if (list == nullptr) return {table.quantity("sigma3", Dimension::stress, range)};
    if (list->empty()) table.check({}, [&] { table.fail("sigma3", "the list is empty", "one stress or more"); });
    std::vector<double> values;
    for (const toml::node& node : *list) table.check({}, [&] { values.push_back(table.quantity_of(node, "sigma3", Dimension::stress, range)); });
    return values;
}

// Rigid grains and inner particles are loaded by plates: does any variant bring them to this kind of test?
bool has_particles(TestKind kind, const std::vector<Variant>& variants) {
    return std::any_of(variants.begin(), variants.end(),
                       [&](const Variant& variant) { return variant.runs(kind) && variant.model.kind != GrainKind::flexible; });
}

// Which motion of the platens follows the branch behind the strength. Fixed speeds know none.
LoadControl read_control(const TableReader& table, TestKind kind, const std::vector<Variant>& variants) {
    const bool adaptive = std::any_of(variants.begin(), variants.end(), [&](const Variant& variant) {
        return variant.runs(kind) && variant.numerics.kind == NumericsKind::adaptive;
    });
    if (!table.has("control")) return usual_control(kind, adaptive);
    const LoadControl control = table.choice("control", load_controls);
    table.check({"control", "kind"}, [&] {
        if (control == LoadControl::lateral_strain && !method_of(kind).loading.widens)
            table.fail("control", fmt::format("'lateral-strain' is meant for specimens that widen as they fail, which kind = \"{}\" does not measure", name(kind)),
                       "control = \"displacement\" or \"dissipation\"");
        if (control != LoadControl::displacement && !adaptive)
            table.fail("control", fmt::format("'{}' changes the platen speed, which only adaptive numerics do", name(control)),
                       "[numerics] kind = \"adaptive\", or control = \"displacement\"");
    });
    return control;
}

// Plates load every Brazilian disc, and all specimens of rigid grains and inner particles.
void read_plates(const TableReader& table, bool particles, const Known& known, TestSpec& test) {
    const std::string setting = "kind = \"" + std::string(name(test.kind)) + "\"";
    const MethodSpecimen& method = method_of(test).specimen;
    if (!method.own_disc && !particles && known.kinds)
        table.refuse({"plate_stiffness_factor", "plate_Kn", "plate_mu", "membrane_plates"}, setting + " of flexible grains",
                     "only with kind = \"brazilian\", or with rigid grains or inner particles, which are loaded by plates");
    if (method.glued)
        table.refuse({"plate_mu"}, setting + ": its plates are glued on and hold in the normal direction only",
                     "plate_stiffness_factor");
    if (!method.confined)
        table.refuse({"membrane_plates"}, setting, "only with kind = \"biaxial\", which has a membrane");
    if (!method.own_disc) table.refuse({"plates", "jaw_radius"}, setting, "only with kind = \"brazilian\"");
    if (!method.own_disc && !particles) return;
    const PlateShape usual = test.plates;
    if (table.has("plates")) test.plates = table.choice("plates", plate_shapes);
    if (table.has("jaw_radius")) {
        if (test.plates != PlateShape::curved)
            table.check({"plates", "disc"}, [&] { table.fail("jaw_radius", "given for flat plates", "plates = \"curved\", which is for a whole disc"); });
        test.jaw_radius = table.number("jaw_radius", {1.0, 1000.0, false, true, "more than 1, in radii of the disc (ISRM: 1.5)"}, test.jaw_radius);
    }
    if (table.has("plate_Kn") && table.has("plate_stiffness_factor"))
        table.check({}, [&] { table.fail("plate_Kn", "given beside plate_stiffness_factor", "one of them"); });
    if (table.has("plate_Kn")) test.plate_Kn_Pa_m = table.quantity("plate_Kn", Dimension::stiffness_gradient, positive);
    else if (test.plates != usual || table.has("plate_stiffness_factor")) test.plate_Kn_Pa_m.reset();   // that of the usual plates
    test.plate_stiffness_factor = table.number("plate_stiffness_factor", positive, test.plate_stiffness_factor);
    if (!method.glued) test.plate_mu = table.number("plate_mu", not_negative, method.plate_mu);
    test.membrane_plates = static_cast<int>(table.integer("membrane_plates", 1, 1000, test.membrane_plates));
}

struct ReadTest {
    std::vector<TestSpec> tests;  // one for each sigma3
    std::optional<double> diameter_m;
    double flat_angle_rad = 0.0;
};

ReadTest read_one(const TableReader& table, const SpecimenSpec& specimen, const std::vector<Variant>& variants, const Known& known) {
    const TestMethod& method = method_of(table.choice("kind", test_kinds));
    const bool kind_known = table.sound({"kind"}), own_disc = method.specimen.own_disc;
    const std::string setting = "kind = \"" + std::string(name(method.kind)) + "\"";
    if (kind_known && !own_disc) table.refuse({"diameter", "disc", "flat_angle"}, setting, "only with kind = \"brazilian\"");
    if (kind_known && !method.specimen.confined) table.refuse({"sigma3"}, setting, "only with kind = \"biaxial\"");
    const bool flattened = kind_known && own_disc && is_flattened(table);
    TestSpec test = usual_test(method.kind, flattened);
    if (known.outline) table.check({"kind"}, [&] { check_outline(table, test.kind, specimen.outline); });

    test.stop_fraction =
        table.fraction("stop_fraction", {0.0, 1.0, false, false, "greater than 0 and less than 1"}, test.stop_fraction);
    test.control = read_control(table, test.kind, variants);
    test.maximum_strain =
        table.fraction("maximum_strain", {0.0, 1.0, false, false, "greater than 0 and less than 1"}, test.maximum_strain);
    if (table.has("maximum_stress")) test.maximum_stress_Pa = table.quantity("maximum_stress", Dimension::stress, positive);
    test.snapshots = static_cast<int>(table.integer("snapshots", 0, 1000, test.snapshots));
    if (table.has("seeds"))
        for (std::uint64_t seed : read_seed_list(table, "seeds")) test.seeds.push_back(seed);
    if (!kind_known) {
        table.quantity("diameter", Dimension::length, positive, 0.0);
        table.quantity("plate_Kn", Dimension::stiffness_gradient, positive, 0.0);
        if (table.has("sigma3")) (void)confining_stresses(table);
        return {};
    }
    read_plates(table, has_particles(test.kind, variants), known, test);

    ReadTest result;
    if (own_disc) {
        result.diameter_m = brazilian_diameter(table, specimen, known);
        result.flat_angle_rad = read_flats(table, flattened, specimen, *result.diameter_m, known, test);
    }
    if (!method.specimen.confined) {
        result.tests.push_back(test);
        return result;
    }
    for (double sigma3 : confining_stresses(table)) {
        test.sigma3_Pa = sigma3;
        table.check({"maximum_stress", "sigma3"}, [&] {
            if (test.maximum_stress_Pa && *test.maximum_stress_Pa <= sigma3)
                table.fail("maximum_stress", "is there before the specimen is loaded", "a sigma1 above sigma3");
        });
        result.tests.push_back(test);
    }
    return result;
}

}  // namespace

std::vector<std::uint64_t> read_seed_list(const TableReader& table, std::string_view key) {
    std::vector<std::uint64_t> seeds;
    for (const toml::node& node : table.array(key))
        table.check({}, [&] {
            const auto seed = static_cast<std::uint64_t>(table.integer_of(node, key, 0, largest_seed));
            if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end())
                table.fail_at(node, key, "the seed " + std::to_string(seed) + " is given twice", "each seed once");
            seeds.push_back(seed);
        });
    if (seeds.empty()) table.check({key}, [&] { table.fail(key, "the list is empty", "one seed or more, such as [1, 2, 3]"); });
    return seeds;
}

TestList read_tests(const TableReader& root, const SpecimenSpec& specimen, const std::vector<Variant>& variants,
                    const std::vector<std::uint64_t>& run_seeds) {
    TestList result;
    if (!root.has("test")) return result;   // a mistake that is noted
    const Known known{
        root.sound({"specimen.shape", "specimen.width", "specimen.height", "specimen.diameter", "specimen.hole_diameter", "specimen.vertices", "specimen.edge_labels",
                    "specimen.holes", "specimen.notches"}),
        root.sound({"specimen.grains.diameter"}), kinds_known(root, variants)};
    std::set<std::string> taken;  // kind, sigma3 as it stands in file names, seed
    for (const TableReader& table : root.tables("test", "a test",
                                                {"kind", "sigma3", "stop_fraction", "control", "maximum_strain", "maximum_stress", "diameter", "disc", "flat_angle",
                                                 "plates", "jaw_radius", "plate_stiffness_factor", "plate_Kn",
                                                 "plate_mu", "membrane_plates", "snapshots", "seeds"})) {
        ReadTest read = read_one(table, specimen, variants, known);
        if (read.diameter_m && std::isfinite(*read.diameter_m)) {
            table.check({"diameter", "disc", "flat_angle"}, [&] {
                if (!result.brazilian_diameter_m) return;
                if (*result.brazilian_diameter_m != *read.diameter_m)
                    table.fail("diameter", "differs from that of an earlier Brazilian test", "one diameter in a job");
                if (result.flat_angle_rad != read.flat_angle_rad)
                    table.fail(table.has("flat_angle") ? "flat_angle" : table.has("disc") ? "disc" : "kind", "the flats of the disc differ from those of an earlier Brazilian test",
                               "one disc in a job");
            });
            result.brazilian_diameter_m = read.diameter_m;
            result.flat_angle_rad = read.flat_angle_rad;
        }
        for (TestSpec& test : read.tests) {
            std::vector<std::uint64_t> seeds(test.seeds.begin(), test.seeds.end());
            if (seeds.empty()) seeds = run_seeds;
            for (std::uint64_t seed : seeds) {
                // as many digits as the names of the result files show
                const double sigma3_MPa = std::round(1e3 * (test.sigma3_Pa / 1e6)) / 1e3;
                const std::string key =
                    std::string(name(test.kind)) +
                    (method_of(test).specimen.confined ? " at sigma3 = " + format_exact(sigma3_MPa) + " MPa" : "");
                const bool again = !taken.insert(key + " s" + std::to_string(seed)).second;
                if (again && root.sound({"run"}))
                    table.check({"kind", "sigma3", "seeds"}, [&] {
                        table.fail(table.has("sigma3") ? "sigma3" : "kind",
                                   key + " with seed " + std::to_string(seed) + " is asked for twice",
                                   "each test once for each seed");
                    });
            }
            result.tests.push_back(std::move(test));
        }
    }
    return result;
}

namespace {

// "auto", here 0, or a number of `things` from 1 to 256.
int read_number_or_auto(const TableReader& table, const char* key, const char* things) {
    const toml::node* node = table.find(key);
    if (node == nullptr || (node->is_string() && node->as_string()->get() == "auto")) return 0;
    if (!node->is_integer()) {
        table.check({}, [&] { table.fail(key, shown(*node) + " is not a number of " + things, "\"auto\", or a whole number from 1 to 256"); });
        return 0;
    }
    return static_cast<int>(table.integer(key, 1, 256));
}

}  // namespace

RunSettings read_run(const TableReader& root) {
    RunSettings run;
    if (!root.has("run")) return run;
    const TableReader table = root.table("run", {"seeds", "seed", "threads", "at_once"});
    if (table.has("seeds") && table.has("seed")) table.check({}, [&] { table.fail("seed", "given beside seeds", "seeds = [1, 2, 3], or seed = 1"); });
    if (table.has("seeds")) run.seeds = read_seed_list(table, "seeds");
    if (table.has("seed")) run.seeds = {static_cast<std::uint64_t>(table.integer("seed", 0, largest_seed))};
    run.threads = read_number_or_auto(table, "threads", "threads");
    run.at_once = read_number_or_auto(table, "at_once", "tests at once");
    return run;
}

}  // namespace feldspar
