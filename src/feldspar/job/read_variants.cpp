#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "feldspar/base/utf8.hpp"
#include "feldspar/job/job_sections.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr std::size_t largest_variant_count = 50;
constexpr std::size_t longest_name = 60;

bool is_plain(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80U;
}  // letters of other scripts have no byte below

std::string read_variant_name(const JobTable& table) {
    std::string given = table.text("name");
    if (!table.sound({"name"})) return given;
    const bool fits = made_of_letters_and(given, " ,.-_%()+=");
    if (!fits || given.size() > longest_name || variant_stem(given).empty() || given.front() == ' ' || given.back() == ' ')
        table.check({},
                    [&] { table.fail("name", shown(*table.find("name")) + " cannot name a variant", table.allowed("name")); });
    return given;
}

std::vector<JobTable> variant_tables(const JobTable& root) {
    std::vector<JobTable> tables = root.tables("variant", "a variant", variant_level);
    if (tables.size() > largest_variant_count)
        root.check({"variant"}, [&] {
            root.fail("variant", std::to_string(tables.size()) + " variants are more than a report can show", "at most 50");
        });
    return tables;
}

Variant read_variant(const JobTable& root, const JobTable* table) {
    Variant variant;
    if (table != nullptr) {
        variant.name = read_variant_name(*table);
        variant.stem = variant_stem(variant.name);
        if (table->has("seeds")) variant.seeds = read_seed_list(*table, "seeds");
        variant.tests = read_kinds(*table);
    }
    Physics physics = read_physics(root, table);
    variant.model = physics.model;
    variant.grain = physics.grain;
    variant.contact = physics.contact;
    variant.rock = std::move(physics.rock);
    variant.numerics = physics.numerics;
    return variant;
}

void check_variant(const JobTable& table, const Variant& variant, const Job& job) {
    for (std::uint64_t seed : variant.seeds)
        if (std::find(job.seeds.begin(), job.seeds.end(), seed) == job.seeds.end())
            table.fail("seeds", "the seed " + std::to_string(seed) + " is not one of the run's", "some of [run] seeds");
    for (MethodId kind : variant.tests)
        if (std::none_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) { return test.kind == kind; }))
            table.fail("tests", "the job has no test of kind '" + std::string(name(kind)) + "'",
                       "kinds that stand in a [[test]]");
    for (const TestSpec& test : job.tests) {
        const std::vector<std::uint64_t> own(test.seeds.begin(), test.seeds.end());
        for (std::uint64_t seed : own.empty() ? job.seeds : own)
            if (variant.runs(test, seed)) return;
    }
    table.fail("seeds", "none of its tests is run with these seeds: nothing is left to run");
}

}  // namespace

std::vector<MethodId> read_kinds(const TableReader& table) {
    std::vector<MethodId> kinds;
    if (!table.has("tests")) return kinds;
    std::vector<std::string_view> words;
    for (MethodId kind : test_methods()) words.emplace_back(name(kind));
    for (const toml::node& node : table.array("tests"))
        table.check({}, [&] {
            const std::string word = table.text_of(node, "tests");
            const auto found = find_method(word);
            if (!found)
                table.fail_at(node, "tests", "'" + word + "' is not a kind of test", listed(words), did_you_mean(word, words));
            if (std::find(kinds.begin(), kinds.end(), *found) != kinds.end())
                table.fail_at(node, "tests", "'" + word + "' is given twice", "each kind once");
            kinds.push_back(*found);
        });
    if (kinds.empty())
        table.check({"tests"},
                    [&] { table.fail("tests", "the list is empty", "one kind of test or more, or leave it out for all"); });
    return kinds;
}

std::string variant_stem(const std::string& name) {
    std::string stem;
    for (char c : name) {
        if (is_plain(c) || (c == '.' && !stem.empty()))
            stem += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        else if (c == '%')
            stem += "pc";
        else if (!stem.empty() && stem.back() != '-')
            stem += '-';
    }
    while (!stem.empty() && !is_plain(stem.back())) stem.pop_back();
    return stem;
}

bool kinds_known(const TableReader& root, const std::vector<Variant>& variants) {
    for (std::size_t i = 0; i < variants.size(); ++i)
        if (!root.sound({"variant[" + std::to_string(i + 1) + "].model.kind"})) return false;
    return root.sound({"model.kind"});
}

std::vector<Variant> read_variants(const JobTable& root) {
    if (!root.has("variant")) return {read_variant(root, nullptr)};
    std::vector<Variant> variants;
    std::map<std::string, std::string> taken;  // stem -> name
    for (const JobTable& table : variant_tables(root)) {
        Variant variant = read_variant(root, &table);
        table.check({"name"}, [&] {
            const auto [other, fresh] = taken.emplace(variant.stem, variant.name);
            if (!fresh)
                table.fail("name",
                           shown(*table.find("name")) + (other->second == variant.name
                                                             ? " is given twice"
                                                             : " would share its files with '" + other->second + "'"),
                           "each variant a name of its own");
        });
        variants.push_back(std::move(variant));
    }
    return variants;
}

std::vector<Mineral> minerals_with_sizes(const JobTable& root, const std::vector<Variant>& variants) {
    const auto sized = [](const Variant& variant) {
        return std::any_of(variant.rock.minerals.phases.begin(), variant.rock.minerals.phases.end(),
                           [](const Mineral& phase) { return phase.sizes.has_value(); });
    };
    const auto first = std::find_if(variants.begin(), variants.end(), sized);
    if (first == variants.end()) return {};
    const std::vector<Mineral>& phases = first->rock.minerals.phases;
    const auto same_sizes = [](const GrainSizeSpec& a, const GrainSizeSpec& b) {
        return a.kind == b.kind && a.minimum_m == b.minimum_m && a.maximum_m == b.maximum_m && a.median_m == b.median_m &&
               a.log_standard_deviation == b.log_standard_deviation &&
               std::equal(a.sieve.begin(), a.sieve.end(), b.sieve.begin(), b.sieve.end(),
                          [](SievePoint p, SievePoint q) { return p.diameter_m == q.diameter_m && p.passing == q.passing; });
    };
    const auto same = [&](const Mineral& a, const Mineral& b) {
        return a.name == b.name && a.share == b.share && a.sizes.has_value() == b.sizes.has_value() &&
               (!a.sizes || same_sizes(*a.sizes, *b.sizes));
    };
    for (const Variant& variant : variants) {
        const std::vector<Mineral>& other = variant.rock.minerals.phases;
        if (other.empty() || std::equal(phases.begin(), phases.end(), other.begin(), other.end(), same))
            continue;  // a rock of one mineral takes the same packing
        root.check({}, [&] {
            root.fail("variant",
                      fmt::format("\"{}\" and \"{}\" differ in the minerals of which their packing is made: names, shares or "
                                  "diameters of [[material.phase]]",
                                  first->name, variant.name),
                      "the same minerals, shares and diameters in all variants, since these share packings", "two jobs");
        });
        break;
    }
    return phases;
}

void check_variants(const JobTable& root, const Job& job) {
    if (!root.has("variant") || !root.sound({"test", "run"})) return;
    const std::vector<JobTable> tables = variant_tables(root);
    for (std::size_t i = 0; i < tables.size(); ++i)
        tables[i].check({"seeds", "tests"}, [&] { check_variant(tables[i], job.variants[i], job); });
}

}  // namespace feldspar
