#include "feldspar/study/base_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "feldspar/base/utf8.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/set_keys.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

std::vector<std::string> split(const std::string& dotted) {
    std::vector<std::string> path;
    std::stringstream stream(dotted);
    for (std::string key; std::getline(stream, key, '.');) path.push_back(key);
    return path;
}

}  // namespace

Measure measure_of(const toml::node& node) {
    if (node.is_number()) return {*node.value<double>(), {}};
    Measure measure{std::numeric_limits<double>::quiet_NaN(), {}};
    if (!node.is_string()) return measure;
    const std::string& text = node.as_string()->get();
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{}) measure = {number, std::string(end, text.data() + text.size())};
    return measure;
}

std::string axis_label(const toml::node& node) {
    if (node.is_string()) return node.as_string()->get();
    std::stringstream text;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_integer<decltype(value)> || toml::is_boolean<decltype(value)>)
            text << value;
        else if constexpr (toml::is_floating_point<decltype(value)>)
            text << fmt::format("{:g}", value.get());
    });
    return text.str();
}

void insert(toml::table& piece, const std::string& key, const toml::node& value) {
    const std::vector<std::string> path = split(key);
    toml::table* table = &piece;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        toml::node* inside = table->get(path[i]);
        if (inside == nullptr || !inside->is_table()) {
            table->insert_or_assign(path[i], toml::table{});
            inside = table->get(path[i]);
        }
        table = inside->as_table();
    }
    table->insert_or_assign(path.back(), value);
}

void insert(toml::table& piece, const std::string& key, const Measure& measure) {
    if (measure.unit.empty())
        insert(piece, key, toml::value<double>(measure.number));
    else
        insert(piece, key,
               toml::value<std::string>(format_exact(measure.number) + (measure.unit.front() == ' ' ? "" : " ") + measure.unit));
}

void lay_over(toml::table& under, const toml::table& over) {
    for (const auto& [key, value] : over) {
        toml::node* there = under.get(key.str());
        const bool both = value.is_table() && there != nullptr && there->is_table();
        if (both && !value.as_table()->contains("distribution"))
            lay_over(*there->as_table(), *value.as_table());
        else
            under.insert_or_assign(key.str(), value);
    }
}

namespace {

bool is_test_kind(std::string_view word) { return find_method(word).has_value(); }

// Keys for every test, and tables named as a kind of test, for the tests of that kind.
void lay_over_tests(toml::array& tests, const toml::table& piece) {
    std::vector<std::string_view> kinds;
    for (const toml::node& test : tests) kinds.push_back(test.as_table()->at("kind").ref<std::string>());
    toml::table for_all;
    for (const auto& [key, value] : piece)
        if (!is_test_kind(key.str())) for_all.insert_or_assign(key, value);
    for (toml::node& test : tests) lay_over(*test.as_table(), for_all);
    for (const auto& [key, value] : piece) {
        if (!is_test_kind(key.str())) continue;
        const std::string dotted = "test." + std::string(key.str());
        if (!value.is_table())
            throw InputError({{}, 0, 0, dotted}, "is not a table of keys for the tests of that kind", dotted + ".<key>");
        if (std::find(kinds.begin(), kinds.end(), key.str()) == kinds.end())
            throw InputError({{}, 0, 0, dotted}, "the job has no test of this kind", listed(kinds));
        for (std::size_t i = 0; i < kinds.size(); ++i)
            if (kinds[i] == key.str()) lay_over(*tests[i].as_table(), *value.as_table());
    }
}

}  // namespace

std::string read_job_key(const TableReader& table, std::string_view key, const std::string& dotted) {
    const std::vector<std::string> path = split(dotted);
    if (path.size() < 2 || std::find(job_pieces.begin(), job_pieces.end(), path.front()) == job_pieces.end() ||
        std::any_of(path.begin(), path.end(), [](const std::string& part) { return part.empty(); }))
        table.check({key}, [&] {
            table.fail(key, "'" + dotted + "' is not a key of a job's " + listed(job_pieces),
                       "a dotted key such as \"material.contact.tau\"");
        });
    return dotted;
}

std::vector<std::pair<std::string, double>> read_coupled(const TableReader& table) {
    const toml::node& node = *table.find("coupled");
    const std::string allowed = "keys and factors, such as { material.contact.Gfs = 31.5 }";
    std::vector<std::pair<std::string, double>> factors;
    if (!node.is_table()) {
        table.check({}, [&] { table.fail("coupled", shown(node) + " is not a table", allowed); });
        return factors;
    }
    const std::function<void(const toml::table&, const std::string&)> walk = [&](const toml::table& inside,
                                                                                 const std::string& path) {
        for (const auto& [key, value] : inside) {
            const std::string full = path.empty() ? std::string(key.str()) : path + "." + std::string(key.str());
            if (value.is_table()) {
                walk(*value.as_table(), full);
            } else {
                table.check({}, [&, &factor = value] {
                    if (!factor.is_number()) table.fail_at(factor, "coupled", shown(factor) + " is not a factor", allowed);
                    factors.emplace_back(read_job_key(table, "coupled", full), *factor.value<double>());
                });
            }
        }
    };
    walk(*node.as_table(), {});
    return factors;
}

toml::table read_piece(const TableReader& table, std::string_view key) {
    const toml::node& node = *table.find(key);
    if (!node.is_table()) {
        table.check(
            {}, [&] { table.fail(key, shown(node) + " is not a piece of a job", "a table such as { model.kind = \"rigid\" }"); });
        return {};
    }
    (void)table.table(key, job_pieces);  // refuses other names
    return *node.as_table();
}

std::string read_directory_name(const TableReader& table, std::string_view key, const std::string& fallback) {
    std::string name = table.text(key, fallback);
    const bool fits = !name.empty() && name.size() <= 100 && name.front() != '.' && made_of_letters_and(name, "-_.");
    if (!fits) {
        table.check({key}, [&] {
            table.fail(key, "'" + name + "' cannot name a directory",
                       "up to 100 letters, digits, '-', '_' and '.', not beginning with '.'");
        });
        return fallback;
    }
    return name;
}

namespace {

const std::array<std::string_view, 2> tables_of_the_job{"variant", "laboratory"};  // which no piece has

bool is_one_of(std::span<const std::string_view> words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// A key of a piece or a setting: the kind of tests that it is for apart; none: all.
struct PieceKey {
    std::vector<std::string> words;
    std::optional<MethodId> kind;

    explicit PieceKey(std::vector<std::string> path) : words(std::move(path)) {
        if (words.size() < 3 || words.front() != "test") return;
        kind = find_method_called(words[1]);
        if (kind) words.erase(words.begin() + 1);
    }
    // Whether both are one key, or one holds the other.
    bool meets(const PieceKey& other) const {
        if (kind && other.kind && *kind != *other.kind) return false;
        const std::size_t shared = std::min(words.size(), other.words.size());
        return std::equal(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(shared), other.words.begin());
    }
};

void for_each_key(const toml::table& piece, const std::string& path, const std::function<void(const std::string&)>& visit) {
    for (const auto& [key, value] : piece) {
        const std::string full = path.empty() ? std::string(key.str()) : path + "." + std::string(key.str());
        if (value.is_table() && !value.as_table()->empty())
            for_each_key(*value.as_table(), full, visit);
        else
            visit(full);
    }
}

}  // namespace

BaseJob::BaseJob(const TableReader& root, const std::filesystem::path& file, std::span<const std::string> settings)
    : file_(root.text("job")) {
    if (file_.is_relative()) file_ = file.parent_path() / file_;
    std::vector<std::string> of_the_job;
    for (const std::string& setting : settings) {
        const std::string table = key_of(setting).front();
        if (is_one_of(tables_of_the_job, table))
            of_the_job.push_back(setting);
        else if (table == "specimen" || table == "test")
            others_.push_back(setting);
        else if (is_one_of(job_pieces, table))
            physics_.push_back(setting);
        else
            throw InputError({place_of(setting), 0, 0, table}, "is no table of a job that can be set here",
                             "keys of " + listed(job_pieces) + ", " + listed(tables_of_the_job) +
                                 "; packings, threads and the like have keys of the file or options of the command");
    }
    root.check({"job"}, [&] {
        try {
            text_ = read_toml_file(file_, "job");
        } catch (const InputError& error) {
            root.fail("job", "'" + file_.string() + "' " + error.problem(),
                      "a job file; a relative path counts from this file's folder");
        }
        const auto parsed = [&] {
            toml::table tree = parse_toml(text_, file_.string());
            set_keys(tree, of_the_job);
            return tree;
        };
        tree_ = parsed();
        job_ = read_tree(of_the_job.empty() ? tree_ : parsed(), text_, file_.string());  // a copy would forget what is a setting
    });
    if (root.has("set")) common_ = read_piece(root, "set");
}

Job BaseJob::with(const toml::table& piece) const {
    toml::table tree = tree_;
    toml::table whole = common_;
    lay_over(whole, piece);
    toml::table variant{{"name", "point"}};
    for (const auto& [key, value] : whole) {
        const std::string_view name = key.str();
        if (name == "specimen") {
            lay_over(*tree.get("specimen")->as_table(), *value.as_table());
        } else if (name == "test") {
            lay_over_tests(*tree.get("test")->as_array(), *value.as_table());
        } else {
            variant.insert_or_assign(name, value);
        }
    }
    tree.insert_or_assign("variant", toml::array{variant});
    set_keys(*tree.get("variant")->as_array()->get(0)->as_table(), physics_);
    set_keys(tree, others_);
    Job job = read_tree(std::move(tree), text_, file_.string());
    job.variants.front().name.clear();
    job.variants.front().stem.clear();
    return job;
}

std::optional<std::string> BaseJob::setting_over(const std::string& key) const {
    const PieceKey wanted(split(key));
    for (const std::vector<std::string>* settings : {&physics_, &others_})
        for (const std::string& setting : *settings)
            if (PieceKey(key_of(setting)).meets(wanted)) return setting;
    return std::nullopt;
}

std::optional<std::string> BaseJob::setting_over(const toml::table& piece) const {
    std::optional<std::string> found;
    for_each_key(piece, {}, [&](const std::string& key) {
        if (!found) found = setting_over(key);
    });
    return found;
}

Measure BaseJob::value_in(const toml::table& piece, const std::string& key) const {
    const toml::table resolved = parse_toml(resolved_toml(with(piece)), "resolved job");
    const toml::node_view<const toml::node> node = toml::at_path(resolved, key);
    if (!node) throw InputError({{}, 0, 0, key}, "the job has no such key, which `times` names", "a key of the resolved job");
    Measure measure = measure_of(*node.node());
    if (std::isnan(measure.number)) throw InputError({{}, 0, 0, key}, "is not a number, which `times` could multiply");
    return measure;
}

}  // namespace feldspar
