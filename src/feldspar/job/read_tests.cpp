#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {
namespace {

// Of a confined specimen's width, as a share of the narrowest: the pressure on sloping sides then adds at most this share of
// sigma3 to the axial stress.
constexpr double most_confined_taper = 0.1;

bool has_label(const OutlineSpec& outline, std::string_view label) {
    return std::find(outline.edge_labels.begin(), outline.edge_labels.end(), label) != outline.edge_labels.end();
}

// What a test is held against, as far as it was read without a mistake.
struct Known {
    bool outline = true;
    bool grain_sizes = true;
    bool kinds = true;  // of the grains of all variants
};

// Platens need a flat top and bottom.
void check_outline(const JobTable& table, MethodId kind, const OutlineSpec& outline) {
    if (method_of(kind).specimen.own_disc) {
        if ((outline.shape == Shape::disc || outline.shape == Shape::ring) && outline.is_cut())
            table.fail("kind",
                       "'" + std::string(name(kind)) +
                           "' cuts its own whole disc: the holes and notches of the specimen would not be in it",
                       "a disc without holes and notches");
        return;
    }
    if (method_of(kind).specimen.confined && outline.is_cut())
        table.fail("kind", "'" + std::string(name(kind)) + "' presses on every side, those of holes and notches too",
                   "a specimen without holes and notches");
    if (outline.shape == Shape::rectangle) return;
    if (outline.shape == Shape::polygon && has_label(outline, "top") && has_label(outline, "bottom")) {
        const SectionWidths widths = section_widths(make_outline(outline));
        if (method_of(kind).specimen.confined && widths.widest > (1.0 + most_confined_taper) * widths.narrowest)
            table.fail("kind",
                       fmt::format("'{}' presses on the sides too, which would load a specimen whose width varies from {:.4g} to "
                                   "{:.4g} mm along "
                                   "its axis as well",
                                   name(kind), 1000.0 * widths.narrowest, 1000.0 * widths.widest),
                       "a rectangle, or a polygon whose width varies by a tenth at most");
        return;
    }
    const std::string shape = outline.shape == Shape::disc        ? "a disc"
                              : outline.shape == Shape::half_disc ? "a half disc"
                              : outline.shape == Shape::ring      ? "a ring"
                                                                  : "a polygon without edges labelled \"top\" and \"bottom\"";
    table.fail("kind", "'" + std::string(name(kind)) + "' presses on flat ends, which " + shape + " has not",
               "shape = \"rectangle\", or a polygon with edges labelled \"top\" and \"bottom\"");
}

// The Brazilian test makes its own disc, of the specimen's width unless the test says otherwise.
double brazilian_diameter(const JobTable& table, const SpecimenSpec& specimen, const Known& known) {
    if (!known.outline) table.do_not_miss({"diameter"});
    if (!table.has("diameter") && specimen.outline.shape == Shape::polygon)
        table.check({"diameter"}, [&] {
            table.fail("diameter", "missing key: diameter (a polygon does not say how large the disc is to be)");
        });
    const double usual = specimen.outline.shape == Shape::rectangle ? specimen.outline.width_m : specimen.outline.diameter_m;
    const double diameter = table.quantity("diameter", usual);
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

// The disc may be whole, or have two flats, on which flat plates press.
bool is_flattened(const JobTable& table) { return table.choice("disc", disc_forms) == DiscForm::flattened; }

// Angle over which a flat is seen from the centre; 0: of a whole disc.
double read_flats(const JobTable& table, bool flattened, const SpecimenSpec& specimen, double diameter_m, const Known& known,
                  const TestSpec& test) {
    if (!flattened) {
        if (table.sound({"disc"})) table.refuse({"flat_angle"}, "a whole disc", "disc = \"flattened\"");
        return 0.0;
    }
    table.check({"plates", "disc"}, [&] {
        if (test.plates == PlateShape::curved)
            table.fail("plates", "curved jaws do not fit the flats of a flattened disc",
                       "plates = \"flat\", or disc = \"whole\"");
    });
    const double angle_rad = table.quantity("flat_angle");
    const double width_m = diameter_m * std::sin(0.5 * angle_rad), largest_m = largest_diameter_m(specimen.grain_sizes);
    table.check({"flat_angle", "disc", "diameter"}, [&] {
        if (known.outline && known.grain_sizes && width_m < largest_m)
            table.fail(table.has("flat_angle") ? "flat_angle" : "disc",
                       fmt::format("the flats would be {:.3g} mm wide, less than the largest grain of {:.3g} mm", 1e3 * width_m,
                                   1e3 * largest_m),
                       "flats wider than the largest grain: a larger angle, a larger disc, or smaller grains");
    });
    return angle_rad;
}

// One or a list: sigma3, or the normal stresses of a shear test.
std::vector<double> given_stresses(const JobTable& table, const char* key) {
    const toml::array* list = table.find(key) == nullptr ? nullptr : table.find(key)->as_array();
    if (list == nullptr) return {table.quantity(key)};
    if (list->empty()) table.check({}, [&] { table.fail(key, "the list is empty", "one stress or more"); });
    std::vector<double> values;
    for (const toml::node& node : *list) table.check({}, [&] { values.push_back(table.quantity_of(node, key)); });
    return values;
}

// Rigid grains and inner particles are loaded by plates: does any variant bring them to this kind of test?
bool has_particles(MethodId kind, const std::vector<Variant>& variants) {
    return std::any_of(variants.begin(), variants.end(),
                       [&](const Variant& variant) { return variant.runs(kind) && variant.model.kind != GrainKind::flexible; });
}

// Which motion of the platens follows the branch behind the strength. Fixed speeds know none.
void read_control(const JobTable& table, const std::vector<Variant>& variants, TestSpec& test) {
    const MethodId kind = test.kind;
    const bool adaptive = std::any_of(variants.begin(), variants.end(), [&](const Variant& variant) {
        return variant.runs(kind) && variant.numerics.kind == NumericsKind::adaptive;
    });
    test.control = usual_control(kind, adaptive);
    if (!table.has("control")) return;
    const std::string given = table.text("control");
    const auto word =
        std::find_if(load_controls.begin(), load_controls.end(), [&](LoadControl control) { return given == name(control); });
    const LoadControl control = word != load_controls.end() ? *word : LoadControl::gauge;
    test.control = control;
    if (control == LoadControl::gauge) test.control_gauge = given;
    table.check({"control", "kind"}, [&] {
        if (control == LoadControl::gauge && !has_gauge(test, given)) {
            std::vector<std::string_view> known;
            for (const LoadControl one : load_controls) known.push_back(name(one));
            for (const std::string_view gauge : gauge_names(test)) known.push_back(gauge);
            table.fail("control", fmt::format("'{}' is neither a control nor a gauge of the test", given), listed(known),
                       did_you_mean(given, known));
        }
        if (control == LoadControl::lateral_strain && !method_of(kind).loading.widens)
            table.fail(
                "control",
                fmt::format(
                    "'lateral-strain' is meant for specimens that widen as they fail, which kind = \"{}\" does not measure",
                    name(kind)),
                "control = \"displacement\" or \"dissipation\"");
        if (control != LoadControl::displacement && !adaptive)
            table.fail("control", fmt::format("'{}' changes the platen speed, which only adaptive numerics do", given),
                       "[numerics] kind = \"adaptive\", or control = \"displacement\"");
    });
}

// "kind = \"brazilian\", ...": those that load by plates whatever the grains are.
std::string plated_methods() {
    std::string text;
    for (const MethodId kind : test_methods())
        if (method_of(kind).specimen.plates) text += (text.empty() ? "kind = \"" : ", \"") + std::string(name(kind)) + "\"";
    return text;
}

// What the method itself has against a specimen, said at the test.
void check_by_method(const JobTable& table, const TestSpec& test, const SpecimenSpec& specimen) {
    table.check({"kind", "span", "fixture"}, [&] {
        try {
            method_of(test).build.check(make_outline(specimen), specimen.thickness_m, test);
        } catch (const InputError& error) {
            const std::string& full = error.place().key;
            const std::string key = full.starts_with("test.") ? full.substr(5) : "kind";
            table.fail(table.has(key) ? key : "kind", error.problem(), error.allowed(), error.suggestion());
        }
    });
}

// Keys of plates where none load the specimen. Those that are another method's are refused already. The ends of flexible grains
// are pressed by plates where these have friction, which makes plates of what otherwise are rows of nodes.
void refuse_plates(const JobTable& table, const TestMethod& method) {
    const bool rubs = !method.specimen.glued && table.has("plate_mu");
    for (const JobKey& key : table.rows().keys) {
        if (!key.of_plates || (!key.when.key.empty() && !key.when.holds(method.name)) || (rubs && key.when.key.empty()) ||
            key.name == "plate_mu")
            continue;
        table.refuse({key.name},
                     "kind = \"" + std::string(method.name) + "\" of flexible grains" +
                         (method.specimen.glued || key.name == "membrane_plates" ? "" : " without plate_mu"),
                     "with plate_mu, the friction of the end plates, beside it; with " + plated_methods() +
                         ", or with rigid grains or inner particles, which are loaded by plates");
    }
}

// Plates load every Brazilian disc, and all specimens of rigid grains and inner particles.
void read_plates(const JobTable& table, bool particles, TestSpec& test) {
    const MethodSpecimen& method = method_of(test).specimen;
    if (!method.plates && !particles && !table.has("plate_mu")) return;
    const PlateShape usual = test.plates;
    if (table.has("plates")) test.plates = table.choice("plates", plate_shapes);
    if (table.has("jaw_radius")) {
        if (test.plates != PlateShape::curved)
            table.check({"plates", "disc"}, [&] {
                table.fail("jaw_radius", "given for flat plates", "plates = \"curved\", which is for a whole disc");
            });
        test.jaw_radius = table.number("jaw_radius");
    }
    if (table.has("plate_Kn") && table.has("plate_stiffness_factor"))
        table.check({}, [&] { table.fail("plate_Kn", "given beside plate_stiffness_factor", "one of them"); });
    if (table.has("plate_Kn"))
        test.plate_Kn_Pa_m = table.quantity("plate_Kn");
    else if (test.plates != usual || table.has("plate_stiffness_factor"))
        test.plate_Kn_Pa_m.reset();  // that of the usual plates
    test.plate_stiffness_factor = table.number("plate_stiffness_factor", test.plate_stiffness_factor);
    if (!method.glued && !method_of(test).specimen.fixtures_of_job) test.plate_mu = table.number("plate_mu", method.plate_mu);
    test.membrane_plates = static_cast<int>(table.integer("membrane_plates"));
}

// The specimen that a test brings itself.
std::optional<SpecimenSpec> own_specimen(const JobTable& table, const TestMethod& method, const SpecimenSpec& of_job,
                                         Known& known) {
    if (!table.has("specimen")) return std::nullopt;
    if (method.specimen.own_disc) {
        table.refuse({"specimen"}, fmt::format("kind = \"{}\"", method.name),
                     "it cuts its own disc: diameter, disc = \"flattened\"");
        return std::nullopt;
    }
    SpecimenSpec own = read_own_specimen(table, of_job, known.grain_sizes);
    const JobTable place = table.table("specimen");
    known.outline = std::ranges::all_of(outline_keys, [&](std::string_view key) { return place.sound({key}); });
    return own;
}

// What the loading does one after the other. Only adaptive numerics turn it.
void read_loading(const JobTable& table, const std::vector<Variant>& variants, TestSpec& test) {
    const auto all = [&](auto fits) {
        return std::ranges::all_of(variants,
                                   [&](const Variant& variant) { return !variant.runs(test.kind) || fits(variant.numerics); });
    };
    if (table.has("stages"))
        test.stages = read_stages(table, test, all([](const NumericsSpec& n) { return n.maximum_steps.has_value(); }));
    table.check({"kind", "stages"}, [&] {
        if (!stages_of(test).empty() && !all([](const NumericsSpec& n) { return n.kind == NumericsKind::adaptive; }))
            table.fail(table.has("stages") ? "stages" : "kind", "the loading turns, which only adaptive numerics do",
                       "[numerics] kind = \"adaptive\"");
    });
}

// The pressures of a multi-stage test: those after the first.
void read_pressures(const JobTable& table, const std::vector<double>& sigma3_Pa, TestSpec& test) {
    table.check({"sigma3"}, [&] {
        if (sigma3_Pa.size() < 2)
            table.fail("sigma3", "a multi-stage test goes through several pressures",
                       "two or more, such as [\"2 MPa\", \"5 MPa\", \"10 MPa\"]");
        if (!std::ranges::is_sorted(sigma3_Pa, std::ranges::less_equal{}))
            table.fail("sigma3", "the pressures of a multi-stage test must rise", "each larger than the one before");
        test.sigma3_Pa = sigma3_Pa.front();
        test.later_sigma3_Pa.assign(sigma3_Pa.begin() + 1, sigma3_Pa.end());
    });
}

// One test for each sigma3.
std::vector<TestSpec> read_one(const JobTable& table, const SpecimenSpec& of_job, const std::vector<Variant>& variants,
                               Known known) {
    const TestMethod& method = table.choice("kind", test_methods()).definition();
    const bool kind_known = table.sound({"kind"}), own_disc = method.specimen.own_disc;
    if (kind_known) table.suit("kind", method.name);
    if (kind_known && known.kinds && !method.specimen.plates && !has_particles(method, variants)) refuse_plates(table, method);
    const bool flattened = kind_known && own_disc && is_flattened(table);
    TestSpec test = usual_test(method, flattened);
    if (kind_known) test.specimen = own_specimen(table, method, of_job, known);
    const SpecimenSpec& specimen = test.specimen ? *test.specimen : of_job;
    if (known.outline && method.build.check == nullptr)
        table.check({"kind"}, [&] { check_outline(table, test.kind, specimen.outline); });

    if (table.has("stop_fraction")) test.stop_fraction = table.fraction("stop_fraction");
    if (kind_known) read_own_keys(table, test);
    read_control(table, variants, test);
    if (known.outline && kind_known && method.build.check != nullptr) check_by_method(table, test, specimen);
    test.maximum_strain = table.fraction("maximum_strain");
    if (table.has("maximum_stress")) test.maximum_stress_Pa = table.quantity("maximum_stress");
    if (kind_known) read_loading(table, variants, test);
    test.snapshots = static_cast<int>(table.integer("snapshots"));
    if (table.has("seeds"))
        for (std::uint64_t seed : read_seed_list(table, "seeds")) test.seeds.push_back(seed);
    if (!kind_known) {
        table.quantity("diameter", 0.0);
        table.quantity("plate_Kn", 0.0);
        for (const char* key : {"sigma3", "normal_stress"})
            if (table.has(key)) (void)given_stresses(table, key);
        return {};
    }
    read_plates(table, has_particles(test.kind, variants), test);

    if (own_disc) {
        const double diameter_m = brazilian_diameter(table, of_job, known),
                     flat_angle_rad = read_flats(table, flattened, of_job, diameter_m, known, test);
        test.specimen = disc_of(of_job, diameter_m, flat_angle_rad);
    }
    if (method.reading == Reading::stages) {
        read_pressures(table, given_stresses(table, "sigma3"), test);
        return {test};
    }
    const MethodSpecimen& needs = method.specimen;
    if ((!needs.confined && !needs.sheared) || (needs.stands_free && !table.has("sigma3"))) return {test};
    std::vector<TestSpec> tests;
    const char* key = pressure_key(method);
    table.require({key});
    if (!table.has(key)) return tests;
    for (double stress : given_stresses(table, key)) {
        test.sigma3_Pa = stress;
        if (needs.confined)
            table.check({"maximum_stress", "sigma3"}, [&] {
                if (test.maximum_stress_Pa && *test.maximum_stress_Pa <= stress)
                    table.fail("maximum_stress", "is there before the specimen is loaded", "a sigma1 above sigma3");
            });
        tests.push_back(test);
    }
    return tests;
}

// The strengths of a method's tests are those of one rock, so all have the same specimen.
void check_one_specimen(const JobTable& table, const SpecimenSpec& of_job, const std::vector<TestSpec>& before,
                        const TestSpec& test) {
    const auto outline = [&](const TestSpec& t) -> const OutlineSpec& {
        return t.specimen ? t.specimen->outline : of_job.outline;
    };
    const auto earlier = std::ranges::find_if(before, [&](const TestSpec& t) { return test_name(t) == test_name(test); });
    if (earlier == before.end() || outline(*earlier) == outline(test)) return;
    table.check({"kind", "specimen", "diameter", "disc", "flat_angle"}, [&] {
        const std::string others =
            fmt::format("an earlier {} test", method_of(test).specimen.own_disc ? "Brazilian" : "'" + test_name(test) + "'");
        if (!method_of(test).specimen.own_disc)
            table.fail(table.has("specimen") ? "specimen" : "kind", "has another specimen than " + others,
                       "one specimen for all tests of a kind; several sizes are an axis of a study");
        if (outline(*earlier).diameter_m != outline(test).diameter_m)
            table.fail("diameter", "differs from that of " + others, "one diameter in a job");
        table.fail(table.has("flat_angle") ? "flat_angle"
                   : table.has("disc")     ? "disc"
                                           : "kind",
                   "the flats of the disc differ from those of " + others, "one disc in a job");
    });
}

}  // namespace

std::vector<std::uint64_t> read_seed_list(const TableReader& table, std::string_view key) {
    const auto [lowest, highest] = whole_numbers(job_key("run", "seeds"));
    std::vector<std::uint64_t> seeds;
    std::set<std::uint64_t> seen;
    for (const toml::node& node : table.array(key))
        table.check({}, [&, least = lowest, most = highest] {
            const auto seed = static_cast<std::uint64_t>(table.integer_of(node, key, least, most));
            if (!seen.insert(seed).second)
                table.fail_at(node, key, "the seed " + std::to_string(seed) + " is given twice", "each seed once");
            seeds.push_back(seed);
        });
    if (seeds.empty()) table.check({key}, [&] { table.fail(key, "the list is empty", "one seed or more, such as [1, 2, 3]"); });
    return seeds;
}

std::vector<TestSpec> read_tests(const JobTable& root, const SpecimenSpec& specimen, const std::vector<Variant>& variants,
                                 const std::vector<std::uint64_t>& run_seeds) {
    std::vector<TestSpec> result;
    if (!root.has("test")) return result;  // a mistake that is noted
    const Known known{
        std::ranges::all_of(outline_keys, [&](std::string_view key) { return root.sound({"specimen." + std::string(key)}); }),
        root.sound({"specimen.grains.diameter"}), kinds_known(root, variants)};
    std::set<std::string> taken;  // kind, sigma3 as it stands in file names, seed
    for (const JobTable& table : root.tables("test", "a test")) {
        std::vector<TestSpec> read = read_one(table, specimen, variants, known);
        if (!read.empty()) check_one_specimen(table, specimen, result, read.front());
        for (TestSpec& test : read) {
            std::vector<std::uint64_t> seeds(test.seeds.begin(), test.seeds.end());
            if (seeds.empty()) seeds = run_seeds;
            for (std::uint64_t seed : seeds) {
                // as many digits as the names of the result files show
                const double sigma3_MPa = std::round(1e3 * (test.sigma3_Pa / 1e6)) / 1e3;
                const std::string key =
                    test_name(test) + (tells_pressure(test) ? fmt::format(" at {} = {} MPa", pressure_key(method_of(test)),
                                                                          format_exact(sigma3_MPa))
                                                            : "");
                const bool again = !taken.insert(key + " s" + std::to_string(seed)).second;
                if (again && root.sound({"run"}))
                    table.check({"kind", "sigma3", "normal_stress", "seeds"}, [&] {
                        const char* of_pressure = pressure_key(method_of(test));
                        table.fail(table.has(of_pressure) ? of_pressure : "kind",
                                   key + " with seed " + std::to_string(seed) + " is asked for twice",
                                   "each test once for each seed");
                    });
            }
            result.push_back(std::move(test));
        }
    }
    return result;
}

namespace {

// "auto", here 0, or a number of `things`.
int read_number_or_auto(const JobTable& table, const char* key, const char* things) {
    const toml::node* node = table.find(key);
    if (node == nullptr || (node->is_string() && node->as_string()->get() == "auto")) return 0;
    if (!node->is_integer()) {
        table.check({}, [&] { table.fail(key, shown(*node) + " is not a number of " + things, table.allowed(key)); });
        return 0;
    }
    return static_cast<int>(table.integer(key));
}

}  // namespace

RunSettings read_run(const JobTable& root) {
    RunSettings run;
    if (!root.has("run")) return run;
    const JobTable table = root.table("run");
    if (table.has("seeds") && table.has("seed"))
        table.check({}, [&] { table.fail("seed", "given beside seeds", "seeds = [1, 2, 3], or seed = 1"); });
    if (table.has("seeds")) run.seeds = read_seed_list(table, "seeds");
    if (table.has("seed")) run.seeds = {static_cast<std::uint64_t>(table.integer("seed"))};
    run.threads = read_number_or_auto(table, "threads", "threads");
    run.at_once = read_number_or_auto(table, "at_once", "tests at once");
    return run;
}

}  // namespace feldspar
