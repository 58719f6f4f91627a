// A study file: the job, the axes, and all points that they make (docs/study.md). A point's job is the base job with pieces laid
// over it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/set_keys.hpp"
#include "feldspar/study/reader_on_job.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {
namespace {

constexpr std::size_t most_points = 100'000;

// A value of an axis: what it is called, the piece of a job that it stands for, and which runs it is for.
struct Choice {
    AxisValue value;
    toml::table piece;
    std::vector<std::uint64_t> seeds;  // empty = all
    std::vector<MethodId> tests;       // empty = all
};

struct Axis {
    std::string name;
    std::string key;    // what `values` are values of; empty for [[axis.value]]
    std::string times;  // the key whose value they multiply; empty if they stand as they are
    std::vector<std::pair<std::string, double>> coupled;
    std::vector<Choice> choices;
};

class StudyReader : private ReaderOnJob {
public:
    StudyReader(const std::string& text, const std::filesystem::path& file, std::span<const std::string> settings)
        : ReaderOnJob(text, file, {"name", "title", "job", "results", "keep", "seeds", "tests", "set", "axis"}, {"job"},
                      settings) {
        study_.file = file;
        study_.text = with_settings(text, settings);
    }

    Study read() {
        read_names(study_);
        read_common();
        if (root_.sound({"job"}) && base_.job().has_variants()) axes_.push_back(variant_axis());
        if (root_.has("axis") && root_.sound({"axis"})) read_axes();
        for (const Axis& axis : axes_) {
            study_.axes.push_back(axis.name);
            refuse_settings_over(axis);
        }
        if (root_.sound({"job", "set", "seeds", "tests", "axis"}))
            root_.check({}, [&] { make_points(); });
        else if (root_.sound({"job", "set"}))
            check_base();
        finish();
        index_runs(study_);
        return std::move(study_);
    }

private:
    void read_common() {
        study_.title = root_.text("title", study_.name);
        study_.keep = root_.choice<Keep>("keep", {{"numbers", Keep::numbers}, {"histories", Keep::histories}, {"all", Keep::all}},
                                         study_.keep);
        seeds_ = root_.has("seeds") ? read_seed_list(root_, "seeds") : std::vector<std::uint64_t>{};
        tests_ = read_kinds(root_);
        for (MethodId kind : tests_) check_kind(root_, kind);
    }

    void check_kind(const TableReader& table, MethodId kind) const {
        const auto& tests = base_.job().tests;
        if (!root_.sound({"job"})) return;
        if (std::none_of(tests.begin(), tests.end(), [&](const TestSpec& test) { return test.kind == kind; }))
            table.check({}, [&] {
                table.fail("tests", fmt::format("the job has no test of kind '{}'", name(kind)),
                           "kinds that stand in a [[test]] of the job");
            });
    }

    Axis variant_axis() const {
        Axis axis;
        axis.name = "variant";
        const toml::array& list = *base_.tree().get("variant")->as_array();
        for (std::size_t v = 0; v < base_.job().variants.size(); ++v) {
            const Variant& variant = base_.job().variants[v];
            Choice choice;
            choice.value = {variant.name, std::numeric_limits<double>::quiet_NaN()};
            for (const char* piece : {"model", "material", "numerics"})
                if (const toml::node* node = list[v].as_table()->get(piece)) choice.piece.insert_or_assign(piece, *node);
            choice.seeds = variant.seeds;
            choice.tests = variant.tests;
            axis.choices.push_back(std::move(choice));
        }
        return axis;
    }

    void read_axes() {
        for (const TableReader& table : root_.tables("axis", "an axis", {"name", "key", "values", "times", "coupled", "value"})) {
            Axis axis = table.has("value") ? read_named_values(table) : read_key_values(table);
            table.check({"name"}, [&] {
                if (std::any_of(axes_.begin(), axes_.end(), [&](const Axis& other) { return other.name == axis.name; }))
                    table.fail("name", "'" + axis.name + "' is the name of another axis", "each axis a name of its own");
            });
            table.check({"value", "values"}, [&] { check_labels(table, axis); });
            axes_.push_back(std::move(axis));
        }
    }

    // A setting would make all points of the axis the same.
    void refuse_settings_over(const Axis& axis) {
        const auto refuse = [&](const std::optional<std::string>& setting) {
            if (!setting) return false;
            const bool variants = axis.name == "variant" && axis.key.empty();
            mistakes_.add(InputError({place_of(*setting), 0, 0, {}},
                                     variants ? "a variant of the job has this key, too"
                                              : fmt::format("the axis '{}' varies this key", axis.name),
                                     "keys that no axis varies", variants ? "--set variant.<key>, or variant.<name>.<key>" : ""),
                          "axis");
            return true;
        };
        for (const auto& [key, factor] : axis.coupled)
            if (refuse(base_.setting_over(key))) return;
        for (const Choice& choice : axis.choices)
            if (refuse(base_.setting_over(choice.piece))) return;
        if (!axis.key.empty()) (void)refuse(base_.setting_over(axis.key));
    }

    static void check_labels(const TableReader& table, const Axis& axis) {
        std::set<std::string> seen;
        for (const Choice& choice : axis.choices)
            if (!seen.insert(choice.value.label).second)
                table.fail(axis.key.empty() ? "value" : "values", "'" + choice.value.label + "' stands there twice",
                           "each value once");
    }

    Axis read_key_values(const TableReader& table) const {
        table.require({"name", "key", "values"});
        Axis axis;
        axis.name = table.text("name");
        axis.key = read_job_key(table, "key", table.text("key"));
        if (table.has("times")) axis.times = read_job_key(table, "times", table.text("times"));
        const toml::array& values = table.array("values");
        if (values.empty()) table.check({"values"}, [&] { table.fail("values", "the list is empty", "one value or more"); });
        for (const toml::node& node : values) {
            Choice choice;
            choice.value = {axis_label(node), measure_of(node).number};
            table.check({}, [&] {
                if (table.has("times") && !node.is_number())
                    table.fail_at(node, "values", shown(node) + " is not a factor",
                                  "plain numbers, which multiply the value of `times`");
            });
            if (table.sound({"key"})) insert(choice.piece, axis.key, node);
            axis.choices.push_back(std::move(choice));
        }
        if (table.has("coupled")) axis.coupled = read_coupled(table);
        return axis;
    }

    Axis read_named_values(const TableReader& table) const {
        table.require({"name"});
        table.refuse({"key", "values", "times", "coupled"}, "[[axis.value]]", "name, and a list of [[axis.value]]");
        Axis axis;
        axis.name = table.text("name");
        for (const TableReader& value : table.tables("value", "a value of the axis", {"label", "set", "seeds", "tests"})) {
            value.require({"label"});
            Choice choice;
            choice.value = {value.text("label"), std::numeric_limits<double>::quiet_NaN()};
            if (value.has("set")) choice.piece = read_piece(value, "set");
            if (value.has("seeds")) choice.seeds = read_seed_list(value, "seeds");
            choice.tests = read_kinds(value);
            for (MethodId kind : choice.tests) check_kind(value, kind);
            axis.choices.push_back(std::move(choice));
        }
        return axis;
    }

    void make_points() {
        std::size_t count = 1;
        for (const Axis& axis : axes_) {
            count *= axis.choices.size();
            if (count > most_points)
                throw InputError({root_.file(), 0, 0, "axis"}, "the axes make more than 100,000 points", "fewer values");
        }
        for (std::size_t p = 0; p < count; ++p) {
            std::vector<const Choice*> chosen(axes_.size());
            std::size_t rest = p;
            for (std::size_t a = axes_.size(); a-- > 0;) {
                chosen[a] = &axes_[a].choices[rest % axes_[a].choices.size()];
                rest /= axes_[a].choices.size();
            }
            make_point(chosen);
        }
    }

    void make_point(const std::vector<const Choice*>& chosen) {
        Point point;
        for (const Choice* choice : chosen) point.values.push_back(choice->value);
        try {
            toml::table piece;
            for (std::size_t a = 0; a < axes_.size(); ++a)
                if (axes_[a].times.empty()) add(piece, axes_[a], *chosen[a]);
            for (std::size_t a = 0; a < axes_.size(); ++a)
                if (!axes_[a].times.empty()) add_multiple(piece, axes_[a], *chosen[a]);
            point.job = base_.with(piece);
        } catch (const InputError& error) {
            note(error, point);
            return;
        }
        point.job.name = study_.name;
        narrow(point.job, chosen, point);
        study_.points.push_back(std::move(point));
    }

    static void add(toml::table& piece, const Axis& axis, const Choice& choice) {
        lay_over(piece, choice.piece);
        if (axis.coupled.empty()) return;
        const toml::node_view<const toml::node> node = toml::at_path(choice.piece, axis.key);
        couple(piece, axis, measure_of(*node.node()));
    }

    static void couple(toml::table& piece, const Axis& axis, const Measure& measure) {
        for (const auto& [key, factor] : axis.coupled) {
            if (std::isnan(measure.number))
                throw InputError({{}, 0, 0, key}, "cannot follow " + axis.key + ", which is not a number",
                                 "no `coupled` beside words");
            insert(piece, key, Measure{factor * measure.number, measure.unit});
        }
    }

    // The axis' values multiply what another key has at this point, presets and defaults included.
    void add_multiple(toml::table& piece, const Axis& axis, const Choice& choice) const {
        Measure measure = base_.value_in(piece, axis.times);
        measure.number *= choice.value.number;
        insert(piece, axis.key, measure);
        couple(piece, axis, measure);
    }

    // Leaves the point's seeds and tests.
    void narrow(Job& job, const std::vector<const Choice*>& chosen, const Point& point) const {
        if (!seeds_.empty()) {
            job.seeds = seeds_;
            for (TestSpec& test : job.tests) test.seeds.clear();
        }
        const auto keep_tests = [&](const std::vector<MethodId>& kinds) {
            if (!kinds.empty())
                std::erase_if(job.tests, [&](const TestSpec& test) {
                    return std::find(kinds.begin(), kinds.end(), test.kind) == kinds.end();
                });
        };
        keep_tests(tests_);
        for (const Choice* choice : chosen) {
            keep_tests(choice->tests);
            if (choice->seeds.empty()) continue;
            const auto dropped = [&](std::uint64_t seed) {
                return std::find(choice->seeds.begin(), choice->seeds.end(), seed) == choice->seeds.end();
            };
            std::erase_if(job.seeds, dropped);
            std::vector<TestSpec> left;  // without tests whose own seeds are all dropped
            for (TestSpec& test : job.tests) {
                const bool own = !test.seeds.empty();
                std::erase_if(test.seeds, dropped);
                if (!own || !test.seeds.empty()) left.push_back(std::move(test));
            }
            job.tests = std::move(left);
        }
        if (job.tests.empty() || job.seeds.empty())
            throw InputError({root_.file(), 0, 0, "axis"}, "nothing is left to run" + at(point),
                             "seeds and tests that the study has");
    }

    std::string at(const Point& point) const {
        std::vector<std::string> words;
        for (std::size_t a = 0; a < point.values.size(); ++a) words.push_back(axes_[a].name + " = " + point.values[a].label);
        return words.empty() ? "" : fmt::format(", with {}", fmt::join(words, ", "));
    }

    // Mistakes that show only in points' jobs: of each the first point that has it.
    void note(const InputError& error, const Point& point) {
        for (const InputError& one : each_mistake(error)) {
            const InputError placed = in_point(one, point);
            const InputError alone(placed.place(), one.problem());
            if (told_.insert(alone.what()).second) mistakes_.add(placed, {});
        }
    }

    // What is wrong with `set`, where axes are broken, so that no point can be made.
    void check_base() {
        try {
            (void)base_.with({});
        } catch (const InputError& error) {
            note(error, {});
        }
    }

    // A mistake that shows only in a point's job: where its key stands in the study, if it does.
    InputError in_point(const InputError& error, const Point& point) const {
        std::string key = error.place().key;
        if (key.starts_with("variant[1].")) key.erase(0, 11);
        if (is_setting(error.place()))
            return InputError({error.place().file, 0, 0, key}, error.problem(), error.allowed(), error.suggestion());
        if (key.starts_with("test[")) key = "test." + key.substr(std::min(key.size(), key.find('.') + 1));
        InputPlace place{root_.file(), 0, 0, key};
        const auto look = [&](const toml::node* node) {
            if (node == nullptr || place.line != 0) return;
            place.line = static_cast<int>(node->source().begin.line);
            place.column = static_cast<int>(node->source().begin.column);
        };
        if (const toml::node* list = tree_.get("axis"); list != nullptr && list->is_array())
            for (const toml::node& axis : *list->as_array()) {
                if (!axis.is_table()) continue;
                if (axis.as_table()->at_path("key").value_or(std::string{}) == key) look(axis.as_table()->get("values"));
                look(axis.as_table()->at_path("coupled." + key).node());
                if (const toml::node* values = axis.as_table()->get("value"); values != nullptr && values->is_array())
                    for (const toml::node& value : *values->as_array())
                        if (value.is_table() &&
                            value.as_table()->at_path("label").value_or(std::string{}) == label_on(point, axis))
                            look(value.as_table()->at_path("set." + key).node());
            }
        look(tree_.at_path("set." + key).node());
        return InputError(place, error.problem() + at(point), error.allowed(), error.suggestion());
    }

    // The label of the point's value on the axis that this node describes.
    std::string label_on(const Point& point, const toml::node& axis) const {
        const std::string name = axis.as_table()->at_path("name").value_or(std::string{});
        for (std::size_t a = 0; a < point.values.size(); ++a)
            if (axes_[a].name == name) return point.values[a].label;
        return {};
    }

    Study study_;
    std::vector<std::uint64_t> seeds_;  // empty = the job's
    std::vector<MethodId> tests_;       // empty = the job's
    std::vector<Axis> axes_;
    std::set<std::string> told_;  // of points' mistakes, without the point
};

}  // namespace

Study parse_study(const std::string& text, const std::filesystem::path& name, std::span<const std::string> settings) {
    return StudyReader(text, name, settings).read();
}

Study read_study(const std::filesystem::path& file, std::span<const std::string> settings) {
    return parse_study(read_toml_file(file, "study"), file, settings);
}

}  // namespace feldspar
