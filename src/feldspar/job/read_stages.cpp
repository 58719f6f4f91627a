// Stages of a test: read one by one, then held against each other, for a stage that cannot end would never let the test go on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/words.hpp"

namespace feldspar {
namespace {

Dimension dimension_of(const TestSpec& test, const StageSpec& stage) {
    switch (stage.end) {
        case StageEnd::stress:
            return Dimension::stress;
        case StageEnd::load:
            return Dimension::force;
        case StageEnd::gauge:
            return dimension_of_gauge(test, stage.gauge);
        default:
            return Dimension::fraction;
    }
}

// A word, or the name of a gauge.
void read_until(const JobTable& table, const TestSpec& test, StageSpec& stage) {
    const std::string given = table.text("until");
    const auto word = std::ranges::find_if(stage_ends, [&](StageEnd end) { return given == name(end); });
    stage.end = word != stage_ends.end() ? *word : StageEnd::gauge;
    if (stage.end != StageEnd::gauge) return;
    stage.gauge = given;
    table.check({"until"}, [&] {
        if (has_gauge(test, given)) return;
        std::vector<std::string_view> known;
        for (const StageEnd end : stage_ends) known.push_back(name(end));
        for (const std::string_view gauge : gauge_names(test)) known.push_back(gauge);
        table.fail("until", fmt::format("'{}' is neither an end of a stage nor a gauge of the test", given), listed(known),
                   did_you_mean(given, known));
    });
}

void read_value(const JobTable& table, const TestSpec& test, StageSpec& stage) {
    constexpr std::pair<const char*, StageValue> keys[]{
        {"at", StageValue::reached}, {"by", StageValue::changed}, {"beyond", StageValue::beyond}};
    const char* given = nullptr;
    for (const auto& [key, counts] : keys) {
        if (!table.has(key)) continue;
        if (given != nullptr)
            table.check({}, [&, &second = key] {
                table.fail(second, fmt::format("given beside {}", given), "one of at, by and beyond");
            });
        given = key;
        stage.counts = counts;
    }
    if (stage.end == StageEnd::reversal) return table.refuse({"at", "by", "beyond"}, "until = \"reversal\"", "leave it out");
    if (given == nullptr)
        return table.check({"until", "kind"}, [&] {
            table.fail("until", fmt::format("until = \"{}\" of what value is missing", table.text("until")), "at, by or beyond");
        });
    stage.value = table.quantity_as(given, dimension_of(test, stage));
    table.check({given}, [&] {
        const bool share = stage.end == StageEnd::share_of_peak;
        if (share && stage.counts != StageValue::reached)
            table.fail(given, "a share of the peak is a value itself", "at = \"80 %\"");
        if (share && !(stage.value > 0.0 && stage.value < 1.0))
            table.fail(given, "is no share to which the load can fall", "greater than 0 and less than 100 %");
        if (stage.counts != StageValue::reached && !(stage.value > 0.0)) table.fail(given, "is no change", "greater than 0");
        const bool of_load = stage.end == StageEnd::stress || stage.end == StageEnd::load;
        if (of_load && stage.counts == StageValue::reached && !(stage.value >= 0.0))
            table.fail(given, "is beyond the unloaded specimen, which hangs on nothing", "0 or more");
        if (stage.kind == StageKind::unload && stage.counts == StageValue::beyond)
            table.fail(given, "counts from where the last loading ended, and this stage unloads", "at or by");
    });
}

StageSpec read_moving(const JobTable& table, const TestSpec& test, StageKind kind) {
    StageSpec stage{.kind = kind};
    if (table.has("until")) {
        read_until(table, test, stage);
        if (table.sound({"until"})) read_value(table, test, stage);
        return stage;
    }
    table.refuse({"at", "by", "beyond"}, "no until", "until = \"stress\" and the like beside it");
    if (kind == StageKind::unload) stage.end = StageEnd::stress;  // to nothing
    return stage;
}

StageSpec read_stage(const JobTable& table, const TestSpec& test, StageForm form) {
    switch (form) {
        case StageForm::load:
            return read_moving(table, test, StageKind::load);
        case StageForm::unload: {
            const StageSpec stage = read_moving(table, test, StageKind::unload);
            table.check({"until"}, [&] {
                if (stage.end == StageEnd::reversal)
                    table.fail("until", "the volumetric strain turns while a specimen is loaded", "kind = \"load\"");
            });
            return stage;
        }
        case StageForm::hold: {
            StageSpec stage{.kind = StageKind::hold};
            if (table.has("travel_times")) stage.travel_times = table.number("travel_times");
            return stage;
        }
        case StageForm::confine: {
            StageSpec stage{.kind = StageKind::confine, .sigma3_Pa = table.quantity("sigma3")};
            if (table.has("fixture")) stage.fixture = table.text("fixture");
            if (table.has("keep")) stage.keep = table.choice("keep", confine_keeps);
            std::vector<std::string_view> pressing;
            for (const FixtureSpec& f : test.custom.fixtures)
                if (f.kind == FixtureKind::pressure || f.kind == FixtureKind::membrane || f.pressed) pressing.push_back(f.name);
            table.check({"kind", "fixture"}, [&] {
                if (pressing.empty())
                    table.fail("kind", "no fixture of this test presses with a pressure that could change",
                               "a fixture with a pressure; or \"load\", \"unload\", \"hold\" and \"cycle\"");
                if (!stage.fixture.empty() && std::ranges::find(pressing, stage.fixture) == pressing.end())
                    table.fail("fixture", fmt::format("'{}' is no fixture with a pressure", stage.fixture), listed(pressing),
                               did_you_mean(stage.fixture, pressing));
            });
            return stage;
        }
        case StageForm::cycle:
            break;
    }
    return {};
}

// What is known of the specimen before a stage: which stresses, loads and strains it has. Nothing is known of what a stage does
// to other quantities.
struct Before {
    std::optional<double> stress_Pa = 0.0, load_N = 0.0, strain = 0.0;

    std::optional<double>* of(StageEnd end) {
        return end == StageEnd::stress         ? &stress_Pa
               : end == StageEnd::load         ? &load_N
               : end == StageEnd::axial_strain ? &strain
                                               : nullptr;
    }
};

struct Placed {
    JobTable table;
    StageSpec stage;
};

void hold_against(const Placed& placed, const TestSpec& test, Before& before) {
    const JobTable& table = placed.table;
    const StageSpec& stage = placed.stage;
    if (stage.kind == StageKind::hold || stage.kind == StageKind::confine) {
        before.stress_Pa.reset();
        before.load_N.reset();
        return;
    }
    const bool reached = stage.counts == StageValue::reached;
    std::optional<double>* known = before.of(stage.end);
    table.check({"kind", "until", "at"}, [&] {
        if (known == nullptr || !reached) return;
        const bool loads = stage.kind == StageKind::load;
        if (known->has_value() && (loads ? stage.value <= **known : stage.value >= **known))
            table.fail(table.has("at") ? "at" : "kind",
                       fmt::format("cannot be reached: the specimen is {} already when this stage begins to {} it",
                                   loads ? "there or beyond" : "there or below", name(stage.kind)),
                       loads ? "more than where the stage before ends, or kind = \"unload\""
                             : "less than where the stage before ends, or kind = \"load\"");
        if (loads && stage.end == StageEnd::axial_strain && stage.value >= test.maximum_strain)
            table.fail("at", fmt::format("cannot be reached: the test ends at an axial strain of {:.3g}", test.maximum_strain),
                       "less, or a larger maximum_strain of the test");
        if (loads && stage.end == StageEnd::stress && test.maximum_stress_Pa && stage.value > *test.maximum_stress_Pa)
            table.fail("at", fmt::format("cannot be reached: the test ends at {:.4g} MPa", *test.maximum_stress_Pa / 1e6),
                       "less, or a larger maximum_stress of the test");
    });
    const double value = stage.value;
    before = {std::nullopt, std::nullopt, std::nullopt};
    if (known != nullptr && reached) *before.of(stage.end) = value;
    if (stage.kind == StageKind::unload && (stage.end == StageEnd::stress || stage.end == StageEnd::load) && value == 0.0 &&
        reached)
        before.stress_Pa = before.load_N = 0.0;
}

// Whether what is repeated changes the specimen: loading each time to the same place may go on for ever.
bool goes_on(const StageGroup& group) {
    return std::ranges::any_of(group.stages, [](const StageSpec& stage) {
        return stage.kind == StageKind::load && (stage.counts != StageValue::reached || stage.end == StageEnd::reversal ||
                                                 stage.end == StageEnd::share_of_peak || stage.end == StageEnd::test);
    });
}

}  // namespace

std::vector<StageGroup> read_stages(const JobTable& table, const TestSpec& test, bool limited_steps) {
    std::vector<StageGroup> groups;
    Before before;
    const std::vector<JobTable> list = table.tables("stages", "a stage");
    for (std::size_t i = 0; i < list.size(); ++i) {
        const JobTable& one = list[i];
        const bool last = i + 1 == list.size();
        const StageForm form = one.choice("kind", stage_forms);
        if (!one.sound({"kind"})) {
            for (const JobKey& key : one.rows().keys) one.do_not_miss({key.name});
            continue;
        }
        one.suit("kind", name(form));
        StageGroup group;
        std::vector<Placed> placed;
        if (form == StageForm::cycle) {
            group.times = one.has("times") ? static_cast<int>(one.integer("times")) : 0;
            if (one.has("stages"))
                for (const JobTable& inner : one.tables("stages", "a stage")) {
                    const StageForm inside = inner.choice("kind", stage_forms);
                    if (!inner.sound({"kind"})) continue;
                    inner.suit("kind", name(inside));
                    inner.check({}, [&] {
                        if (inside == StageForm::cycle) inner.fail("kind", "a cycle in a cycle", "stages");
                    });
                    placed.push_back({inner, read_stage(inner, test, inside)});
                }
        } else {
            placed.push_back({one, read_stage(one, test, form)});
        }
        if (i == 0 && !placed.empty())
            placed.front().table.check({"kind"}, [&] {
                const StageKind kind = placed.front().stage.kind;
                if (kind == StageKind::unload || kind == StageKind::hold)
                    placed.front().table.fail("kind", "the specimen is not loaded yet", "\"load\" or \"confine\" first");
            });
        for (const Placed& p : placed) group.stages.push_back(p.stage);
        const int passes = form == StageForm::cycle && group.times != 1 ? 2 : 1;  // the second one begins where the first ended
        for (int pass = 0; pass < passes; ++pass)
            for (std::size_t k = 0; k < placed.size(); ++k) {
                hold_against(placed[k], test, before);
                const bool end_of_all = last && k + 1 == placed.size() && group.times == 1;
                placed[k].table.check({"kind", "until"}, [&] {
                    if (placed[k].stage.kind == StageKind::load && placed[k].stage.end == StageEnd::test && !end_of_all)
                        placed[k].table.fail(placed[k].table.has("until") ? "until" : "kind",
                                             "loads until the test ends, and stages stand behind it",
                                             "until = \"stress\" and the like, or no stages behind");
                });
            }
        one.check({"times", "stages"}, [&] {
            if (group.times != 0) return;
            if (!last)
                one.fail("kind", "is repeated until the test ends, and stages stand behind it", "times = 5, or no stages behind");
            if (!goes_on(group) && !limited_steps)
                one.fail("kind", "may go on for ever: every loading of it goes to the same value",
                         "times = 5, or a loading with by, beyond or until = \"reversal\", or maximum_steps in [numerics]");
        });
        if (!group.stages.empty()) groups.push_back(std::move(group));
    }
    return groups;
}

}  // namespace feldspar
