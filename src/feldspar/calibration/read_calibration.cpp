#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "feldspar/calibration/calibration.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/set_keys.hpp"
#include "feldspar/lab/rock_properties.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/study/reader_on_job.hpp"

namespace feldspar {
namespace {

// How a target is judged unless its tolerance is given.
struct TargetKind {
    const char* name;
    double tolerance;  // a fraction of the value; of nu and the angle the value itself
    bool absolute = false;

    // How it is written; none: a plain number.
    std::optional<Dimension> dimension() const { return kept_rock_property(property_of({name}))->unit.written; }
};

constexpr double degree = std::numbers::pi / 180.0;

const std::vector<TargetKind> target_kinds{
    {"E", 0.02},
    {"nu", 0.01, true},
    {"UCS", 0.03},
    {"DTS", 0.02},
    {"BTS", 0.10},
    {"UCS_over_BTS", 0.10},
    {"UCS_over_DTS", 0.04},
    {"BTS_over_DTS", 0.10},
    {"cohesion", 0.05},
    {"friction_angle", 2.0, true},
    {"hoek_brown_mi", 0.10},
    {"sigma_ci", 0.10},
    {"sigma_cd", 0.10},
    {"sigma_ci_over_UCS", 0.10},
    {"sigma_cd_over_UCS", 0.10},
    {"sigma1", 0.03},
};

constexpr double toughest = 300.0;  // N/m: rocks of 200 are to lie inside

double six_digits(double value) {
    return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}  // stod refuses what is next to zero

// Of a default range: what the rock's numbers say of a contact's.
struct RangeRule {
    const char* key;
    double low, high;
    bool elastic = false;
    bool logarithmic = true;
};

class CalibrationReader : private ReaderOnJob {
public:
    CalibrationReader(const std::string& text, const std::filesystem::path& file, std::span<const std::string> settings)
        : ReaderOnJob(text, file, {"name", "job", "set", "results", "seeds", "confirm_seeds", "budget", "targets", "unknown"},
                      {"job", "targets", "unknown"}, settings),
          result_{file, with_settings(text, settings), {}, {}, base_, {}, {}, {}, {}, 300, {}} {}

    Calibration read() {
        read_names(result_);
        root_.check({"job"}, [&] {
            if (base_.job().has_variants())
                root_.fail("job", "has variants, but one rock is calibrated at a time", "a job without [[variant]]");
        });
        if (root_.sound({"job", "set"})) read_set();
        read_seeds();
        read_targets();
        read_unknowns();
        root_.check({"job", "targets", "unknown"}, [&] { check_determined(); });
        finish();
        return std::move(result_);
    }

private:
    void read_set() {
        try {
            rock_ = base_.with({});
        } catch (const InputError& error) {
            for (const InputError& one : each_mistake(error))
                mistakes_.add(is_setting(one.place())
                                  ? one
                                  : InputError({root_.file(), 0, 0, "set"}, one.place().key + " " + one.problem(), one.allowed(),
                                               one.suggestion()),
                              "set");
        }
    }

    void read_seeds() {
        if (root_.has("seeds"))
            result_.seeds = read_seed_list(root_, "seeds");
        else
            for (std::uint64_t seed = 1; seed <= 20; ++seed) result_.seeds.push_back(seed);
        if (root_.has("confirm_seeds"))
            result_.confirm_seeds = read_seed_list(root_, "confirm_seeds");
        else
            for (std::uint64_t seed = 1001; seed <= 1010; ++seed) result_.confirm_seeds.push_back(seed);
        for (const std::uint64_t seed : result_.confirm_seeds)
            if (std::find(result_.seeds.begin(), result_.seeds.end(), seed) != result_.seeds.end())
                root_.check({"seeds", "confirm_seeds"}, [&] {
                    root_.fail(root_.has("confirm_seeds") ? "confirm_seeds" : "seeds",
                               fmt::format("the packing {} is also one that calibration learns from", seed),
                               "fresh packings, which confirm what was learned");
                });
        result_.budget = static_cast<int>(root_.integer("budget", 20, 100'000, 300));
    }

    void read_targets() {
        std::vector<std::string_view> names;
        for (const TargetKind& kind : target_kinds) names.emplace_back(kind.name);
        const TableReader table = root_.table("targets", names);
        for (const TargetKind& kind : target_kinds) {
            if (!table.has(kind.name)) continue;
            const toml::node& node = *table.find(kind.name);
            if (std::string(kind.name) == "sigma1") {
                for (const toml::node& item : table.array(kind.name))
                    table.check({}, [&] {
                        if (!item.is_table())
                            table.fail_at(item, kind.name, shown(item) + " is not a strength under confinement",
                                          "{ sigma3 = \"10 MPa\", value = \"190 MPa\" }");
                        const TableReader one(*item.as_table(), "targets.sigma1", root_.file(),
                                              {"sigma3", "value", "tolerance", "standard_deviation"}, 0, &mistakes_);
                        one.require({"sigma3", "value"});
                        Target target = read_target(one, kind);
                        target.sigma3_Pa = one.quantity("sigma3", Dimension::stress, positive);
                        result_.targets.push_back(target);
                    });
            } else if (node.is_table()) {
                const TableReader one = table.table(kind.name, {"value", "tolerance", "standard_deviation"});
                one.require({"value"});
                result_.targets.push_back(read_target(one, kind));
            } else {
                Target target{kind.name, 0.0, read_value(table, kind.name, kind), 0.0};
                target.tolerance = kind.absolute ? kind.tolerance : kind.tolerance * target.value;
                result_.targets.push_back(target);
            }
        }
        if (result_.targets.empty())
            root_.check({"targets"}, [&] { root_.fail("targets", "there is no target", listed(names)); });
        root_.check({"targets"}, [&] { check_order(table); });
        if (!root_.sound({"job", "set", "targets"})) return;
        std::vector<double>& sigma3 = result_.sigma3_Pa;
        for (const TestSpec& test : rock_.tests)
            if (method_of(test).specimen.confined) sigma3.push_back(test.sigma3_Pa);
        for (const Target& target : result_.targets) {
            const bool envelope = target.name == "cohesion" || target.name == "friction_angle" || target.name == "hoek_brown_mi";
            table.check({}, [&] {
                if (envelope && sigma3.empty())
                    table.fail(target.name, "is read from confined tests, and the job has none",
                               "a biaxial [[test]] in the job, with the laboratory's range of sigma3");
                if (target.name == "sigma1" && std::find(sigma3.begin(), sigma3.end(), target.sigma3_Pa) == sigma3.end())
                    table.fail("sigma1", fmt::format("the job has no biaxial test at {:g} MPa", target.sigma3_Pa / 1e6),
                               "a sigma3 of the job's biaxial tests");
            });
        }
        if (!root_.sound({"targets"})) return;
        for (const Observable& quantity : observables_for(result_))
            root_.check({}, [&] {
                if (std::none_of(rock_.tests.begin(), rock_.tests.end(),
                                 [&](const TestSpec& test) { return test.kind == quantity.test; }))
                    root_.fail("targets", fmt::format("{} is read from a test that the job does not have", quantity.name),
                               fmt::format("a [[test]] of kind \"{}\" in the job", name(quantity.test)));
            });
    }

    // No rock is weaker in compression than in tension: Griffith's criterion has a ratio of 8, rocks have 5 to 30.
    void check_order(const TableReader& table) const {
        constexpr const char* allowed =
            "a uniaxial strength above the tensile one; rocks have 5 to 30 times as much. Are the two exchanged?";
        const double UCS = wanted_UCS_Pa(result_.targets);
        for (const char* tension : {"BTS", "DTS"}) {
            const double strength = target_value(tension, result_.targets);
            if (UCS <= strength)
                table.fail(table.has("UCS") ? "UCS" : "cohesion",
                           fmt::format("a uniaxial strength of {:.4g} MPa is not above {} = {:.4g} MPa", UCS / 1e6, tension,
                                       strength / 1e6),
                           allowed);
            const std::string ratio = std::string("UCS_over_") + tension;
            const double given = target_value(ratio, result_.targets);
            if (given <= 1.0)
                table.fail(ratio, fmt::format("a ratio of {:.4g} means a uniaxial strength that is not above {}", given, tension),
                           allowed);
        }
        for (const Target& target : result_.targets)
            if (target.name == "sigma1" && target.value <= UCS)
                table.fail("sigma1",
                           fmt::format("a strength of {:.4g} MPa under {:g} MPa is not above the uniaxial one of {:.4g} MPa",
                                       target.value / 1e6, target.sigma3_Pa / 1e6, UCS / 1e6),
                           "strengths that grow with the confinement");
    }

    double read_value(const TableReader& table, std::string_view key, const TargetKind& kind) const {
        const std::optional<Dimension> dimension = kind.dimension();
        if (!dimension) return table.number(key, positive);
        const double value = table.quantity(key, *dimension, positive);
        return *dimension == Dimension::angle ? value / degree : value;
    }

    Target read_target(const TableReader& table, const TargetKind& kind) const {
        Target target{kind.name, 0.0, read_value(table, "value", kind), 0.0};
        if (table.has("tolerance") && table.has("standard_deviation"))
            table.check({}, [&] { table.fail("standard_deviation", "given beside tolerance", "one of the two"); });
        const char* key = table.has("tolerance") ? "tolerance" : "standard_deviation";
        target.tolerance = kind.absolute ? kind.tolerance : kind.tolerance * target.value;
        if (!table.has(key)) return target;
        const toml::node& node = *table.find(key);
        const bool percent = node.is_string() && node.as_string()->get().find('%') != std::string::npos;
        target.tolerance = percent ? table.fraction(key, positive) * target.value : read_value(table, key, kind);
        return target;
    }

    // By how much the specimen's numbers and those of its contacts differ in rocks of this kind (docs/calibration.md).
    std::vector<RangeRule> range_rules() const {
        const auto target = [&](const char* name) { return target_value(name, result_.targets); };
        const auto first = [](std::initializer_list<double> values) {
            for (const double value : values)
                if (std::isfinite(value)) return value;
            return std::nan("");
        };
        const double E = target("E"), ratio = target("UCS_over_BTS");
        const double UCS = wanted_UCS_Pa(result_.targets);
        const double tension = first({target("DTS"), target("BTS"), UCS / first({ratio, 13.0})});
        const double diameter = typical_diameter_m(rock_.specimen.grain_sizes);
        // fracture energy of a rock whose cohesive zone, E Gf / strength^2, is as long as a grain is wide; granite: 8.5 N/m
        const double energy = first({tension * tension / E * diameter, 8.5});
        const GrainKind kind = rock_.variants.front().model.kind;
        const bool flexible = kind == GrainKind::flexible;
        // from where contacts are brittle, sigma_nt^2 / (2 Kn) of stiff contacts, to what the toughest rocks have
        const double brittle = flexible ? 0.03 : 0.4;
        const double body =
            kind == GrainKind::inner_particles ? diameter / std::sqrt(rock_.specimen.particles_per_grain) : diameter;
        return {{"material.grain.E", 0.8 * E, 1.6 * E, true},
                {"material.grain.nu", 0.1, 0.4, true, false},
                {"material.contact.Kn", (flexible ? 4.0 : 0.5) * E / body, (flexible ? 60.0 : 4.0) * E / body, true},
                {"material.contact.eta", 0.1, 1.0, true},
                {"material.contact.kratio", 1.0, 10.0, true},
                {"material.contact.sigma_nt", 0.5 * tension, 2.5 * tension},
                {"material.contact.tau", 0.1 * UCS, 0.6 * UCS},
                {"material.contact.mu", 0.1, 1.0, false, false},
                {"material.contact.Gfn", brittle * energy, std::max(25.0 * energy, toughest)},
                {"material.contact.Gfs", 12.0 * energy, 500.0 * energy},
                {"material.scatter.strength.modulus", 1.2, 10.0},
                {"material.initial_cracks.broken", 0.02, 0.4},
                {"material.minerals.unlike_strength", 0.2, 1.0}};
    }

    // What multiplies another key is a ratio.
    static std::optional<std::pair<double, double>> ratio_rule(const std::string& key) {
        if (key == "material.contact.tau") return std::pair{1.5, 6.0};
        if (key == "material.contact.Gfs") return std::pair{5.0, 300.0};
        return std::nullopt;
    }

    void read_unknowns() {
        for (const TableReader& table :
             root_.tables("unknown", "an unknown", {"name", "key", "times", "coupled", "range", "scale"}))
            result_.unknowns.push_back(read_unknown(table));
        for (const Unknown& unknown : result_.unknowns) refuse_settings_over(unknown);
        for (std::size_t i = 0; i < result_.unknowns.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (result_.unknowns[i].key == result_.unknowns[j].key && !result_.unknowns[i].key.empty())
                    root_.check(
                        {}, [&] { root_.fail("unknown", "'" + result_.unknowns[i].key + "' is given twice", "each key once"); });
        if (!root_.sound({"job", "set", "targets", "unknown"})) return;
        try {
            std::vector<double> low, high;
            for (const Unknown& unknown : result_.unknowns) {
                low.push_back(unknown.low);
                high.push_back(unknown.high);
            }
            (void)result_.job_with(low);
            (void)result_.job_with(high);
        } catch (const InputError& error) {
            for (const InputError& one : each_mistake(error))
                mistakes_.add(InputError({root_.file(), 0, 0, one.place().key}, "at an end of the ranges: " + one.problem(),
                                         one.allowed(), one.suggestion()),
                              {});
        }
    }

    // Behind it the unknown would be lost.
    void refuse_settings_over(const Unknown& unknown) {
        std::optional<std::string> setting = base_.setting_over(unknown.key);
        for (const auto& [key, factor] : unknown.coupled)
            if (!setting) setting = base_.setting_over(key);
        if (setting)
            mistakes_.add(InputError({place_of(*setting), 0, 0, {}},
                                     fmt::format("the unknown '{}' decides this key", unknown.name), "keys that are not sought"),
                          "unknown");
    }

    Unknown read_unknown(const TableReader& table) {
        table.require({"key"});
        Unknown unknown;
        unknown.key = read_job_key(table, "key", table.text("key"));
        unknown.name = table.text("name", unknown.key.substr(unknown.key.rfind('.') + 1));
        if (table.has("times")) unknown.times = read_job_key(table, "times", table.text("times"));
        if (table.has("coupled")) unknown.coupled = read_coupled(table);
        const bool rules_known = root_.sound({"job", "set", "targets"});
        const std::vector<RangeRule> rules = rules_known ? range_rules() : std::vector<RangeRule>{};
        const auto rule = std::find_if(rules.begin(), rules.end(), [&](const RangeRule& r) { return unknown.key == r.key; });
        if (rule != rules.end()) {
            unknown.elastic = rule->elastic;
            unknown.logarithmic = rule->logarithmic || !unknown.times.empty();
        }
        if (table.has("range"))
            read_range(table, unknown);
        else if (!unknown.times.empty() && ratio_rule(unknown.key))
            std::tie(unknown.low, unknown.high) = *ratio_rule(unknown.key);
        else if (unknown.times.empty() && rule != rules.end() && std::isfinite(rule->low)) {
            const UserUnit unit = unit_of(unknown.key);
            unknown.low = six_digits(rule->low / unit.in_SI);
            unknown.high = six_digits(rule->high / unit.in_SI);
            unknown.unit = unit.name;
        } else {
            if (!rules_known) table.do_not_miss({"range"});
            table.check({"key", "times", "range"}, [&] {
                table.fail("range", "is missing: neither the key nor the targets say what is usual", "range = [lowest, highest]");
            });
        }
        unknown.logarithmic = table.choice<bool>("scale", {{"log", true}, {"linear", false}}, unknown.logarithmic);
        table.check({"key", "range"}, [&] {
            if (!(unknown.low < unknown.high)) table.fail("range", "is empty", "the lower value first");
        });
        const bool usual_scale = table.has("scale") || rules_known;  // without the rules "linear" may be the usual one
        if (unknown.logarithmic && usual_scale)
            table.check({"key", "range", "scale"}, [&] {
                if (!(unknown.low > 0.0))
                    table.fail("range", "begins at zero or below, and is divided by its logarithm",
                               "a lower end above zero, or scale = \"linear\"");
            });
        return unknown;
    }

    struct UserUnit {
        const char* name;
        double in_SI;
    };
    static UserUnit unit_of(const std::string& key) {
        if (key.ends_with(".E")) return {"GPa", 1e9};
        if (key.ends_with(".sigma_nt") || key.ends_with(".tau")) return {"MPa", 1e6};
        if (key.ends_with(".Kn")) return {"GPa/m", 1e9};
        if (key.ends_with(".Gfn") || key.ends_with(".Gfs")) return {"N/m", 1.0};
        return {"", 1.0};
    }

    void read_range(const TableReader& table, Unknown& unknown) const {
        const toml::array& range = table.array("range");
        table.check({"range"}, [&] {
            if (range.size() != 2)
                table.fail("range", fmt::format("has {} values", range.size()), "two: the lowest and the highest");
            const Measure low = measure_of(range[0]), high = measure_of(range[1]);
            if (std::isnan(low.number) || std::isnan(high.number))
                table.fail("range", "has values that do not begin with a number", "such as [\"5 MPa\", \"20 MPa\"]");
            if (low.unit != high.unit)
                table.fail("range", fmt::format("has the units '{}' and '{}'", low.unit, high.unit), "the same unit twice");
            unknown.low = low.number;
            unknown.high = high.number;
            unknown.unit = low.unit;
        });
    }

    // Unknowns that no target can tell anything of.
    void check_determined() const {
        const auto elastic_target = [](const Target& target) { return target.name == "E" || target.name == "nu"; };
        const bool any_elastic = std::any_of(result_.targets.begin(), result_.targets.end(), elastic_target);
        const bool any_strength =
            std::any_of(result_.targets.begin(), result_.targets.end(), [&](const Target& t) { return !elastic_target(t); });
        for (const Unknown& unknown : result_.unknowns) {
            if (unknown.elastic && !any_elastic)
                root_.fail("unknown", fmt::format("{} changes E and nu, and neither is a target", unknown.name),
                           "a target E or nu, or the key fixed in the job");
            if (!unknown.elastic && !any_strength)
                root_.fail("unknown", fmt::format("{} changes strengths, and none is a target", unknown.name),
                           "a strength among the targets, or the key fixed in the job");
        }
    }

    Calibration result_;
    Job rock_;  // the job before anything is known of the unknowns
};

}  // namespace

Calibration parse_calibration(const std::string& text, const std::filesystem::path& name, std::span<const std::string> settings) {
    return CalibrationReader(text, name, settings).read();
}

Calibration read_calibration(const std::filesystem::path& file, std::span<const std::string> settings) {
    return parse_calibration(read_toml_file(file, "calibration"), file, settings);
}

std::string Target::label() const { return name == "sigma1" ? fmt::format("sigma1 at {:g} MPa", sigma3_Pa / 1e6) : name; }

double Unknown::value_at(double x) const {
    const double inside = std::clamp(x, 0.0, 1.0);
    return six_digits(logarithmic ? low * std::pow(high / low, inside) : low + (high - low) * inside);
}

double Unknown::x_of(double value) const {
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

Job Calibration::job_with(const std::vector<double>& values) const {
    toml::table piece;
    const auto put = [&](const Unknown& unknown, const Measure& measure) {
        insert(piece, unknown.key, measure);
        for (const auto& [key, factor] : unknown.coupled) insert(piece, key, Measure{factor * measure.number, measure.unit});
    };
    for (std::size_t i = 0; i < unknowns.size(); ++i)
        if (unknowns[i].times.empty()) put(unknowns[i], {values[i], unknowns[i].unit});
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
        if (unknowns[i].times.empty()) continue;
        Measure measure = base.value_in(piece, unknowns[i].times);
        measure.number = six_digits(measure.number * values[i]);
        put(unknowns[i], measure);
    }
    Job job = base.with(piece);
    job.name = name;
    return job;
}

}  // namespace feldspar
