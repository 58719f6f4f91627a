// A job with what the command line says of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "commands.hpp"
#include "feldspar/base/counted.hpp"
#include "feldspar/base/usable_cores.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

// Leaves the variants that the command line names, in the job's order.
void keep_variants(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    if (!job.has_variants())
        throw InputError({{}, 0, 0, "--variant"}, "the job has no variants", "the job as it is, without --variant");
    std::vector<std::string_view> names;
    for (const Variant& variant : job.variants) names.push_back(variant.name);
    const auto is = [](const Variant& variant, const std::string& name) { return variant.name == name || variant.stem == name; };
    for (const std::string& name : wanted)
        if (std::none_of(job.variants.begin(), job.variants.end(), [&](const Variant& variant) { return is(variant, name); }))
            throw InputError({{}, 0, 0, "--variant"}, fmt::format("the job has no variant '{}'", name),
                             fmt::format("{}", fmt::join(names, "; ")), did_you_mean(name, names));
    std::erase_if(job.variants, [&](const Variant& variant) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const std::string& name) { return is(variant, name); });
    });
}

// Leaves the tests of the kinds that the command line names.
void keep_tests(Job& job, const std::vector<std::string>& wanted) {
    if (wanted.empty()) return;
    std::vector<std::string_view> kinds;
    for (const TestSpec& test : job.tests)
        if (std::find(kinds.begin(), kinds.end(), name(test.kind)) == kinds.end()) kinds.emplace_back(name(test.kind));
    for (const std::string& kind : wanted)
        if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
            throw InputError({{}, 0, 0, "--test"}, fmt::format("the job has no test '{}'", kind), listed(kinds),
                             did_you_mean(kind, kinds));
    std::erase_if(job.tests,
                  [&](const TestSpec& test) { return std::find(wanted.begin(), wanted.end(), name(test.kind)) == wanted.end(); });
    for (const Variant& variant : job.variants)
        if (std::none_of(job.tests.begin(), job.tests.end(), [&](const TestSpec& test) { return variant.runs(test.kind); }))
            throw InputError({{}, 0, 0, "--test"}, fmt::format("nothing is left to run for the variant '{}'", variant.name), {},
                             "name the --variant too");
}

}  // namespace

std::vector<std::string> full_kinds(std::vector<std::string> words) {
    for (std::string& word : words)
        if (const auto method = find_method_called(word)) word = name(*method);
    return words;
}

Job job_with_options(const JobOptions& options) {
    Job job = options.job == "-" ? parse_job(read_toml_file("/dev/stdin", "job"), "standard input", options.settings)
                                 : read_job(options.job, options.settings);
    keep_variants(job, options.variants);
    keep_tests(job, full_kinds(options.tests));
    if (options.threads) job.threads = *options.threads;
    if (options.at_once) job.at_once = *options.at_once;
    if (options.seeds.empty()) return job;
    for (std::uint64_t seed : options.seeds)
        if (std::count(options.seeds.begin(), options.seeds.end(), seed) > 1)
            throw InputError({{}, 0, 0, "--seed"}, fmt::format("the seed {} is given twice", seed), "each seed once");
    if (!job.specimen.packing_file.empty() && options.seeds.size() > 1)
        throw InputError({{}, 0, 0, "--seed"}, "several seeds are asked for, but the job loads one packing", "one seed");
    job.seeds = options.seeds;
    for (TestSpec& test : job.tests) test.seeds.clear();
    for (Variant& variant : job.variants) variant.seeds.clear();
    return job;
}

int thread_count(int wanted) {
    const int cores = usable_cores();
    if (wanted == 0) return cores;
    if (wanted > cores) say(stderr, "warning: {} threads on {} will wait for each other\n", wanted, counted(cores, "core"));
    return wanted;
}

}  // namespace feldspar
