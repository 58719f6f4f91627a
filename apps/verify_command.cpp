#include <fmt/format.h>

#include <regex>

#include "commands.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/verify/write_checks.hpp"
#include "say.hpp"
#include "terminal.hpp"

namespace feldspar {
namespace {

std::function<bool(const Check&)> filter_of(const std::optional<std::string>& only) {
    if (!only) return {};
    try {
        return [pattern = std::regex(*only)](const Check& check) { return std::regex_search(check.name, pattern); };
    } catch (const std::regex_error&) {
        throw InputError({{}, 0, 0, "--only"}, fmt::format("'{}' is not a regular expression", *only),
                         "a part of names, such as \"two-grains|beams\"; 'feldspar verify --list' prints them");
    }
}

std::size_t count(const std::vector<Topic>& topics, const std::function<bool(const Check&)>& filter) {
    std::size_t number = 0;
    for (const Topic& topic : topics)
        for (const Check& check : topic.checks) number += !filter || filter(check) ? 1 : 0;
    return number;
}

}  // namespace

ExitCode verify_command(const VerifyOptions& options) {
    const std::vector<Topic>& topics = all_topics();
    const auto filter = filter_of(options.only);
    const std::size_t total = count(topics, filter);
    if (total == 0)
        throw InputError({{}, 0, 0, "--only"}, fmt::format("no check has a name that matches '{}'", options.only.value_or("")),
                         "a part of the names that 'feldspar verify --list' prints");
    if (options.list) {
        say("{}", checks_list(topics, filter, output_columns()));
        return ExitCode::success;
    }
    const std::optional<std::filesystem::path> wanted = options.out;
    RunDirectory::check(wanted, "verify");
    const int threads = thread_count(options.threads);
    const Provenance provenance = collect_provenance(options.command_line, threads);
    std::size_t done = 0;
    const std::vector<CheckResult> results = run_checks(topics, filter, threads, [&](const CheckResult& result) {
        say(stderr, "{}/{}  {:7}  {:.1f} s  {}\n", ++done, total, result.within() ? "within" : "OUTSIDE", result.seconds,
            result.check->name);
    });
    const RunDirectory directory = RunDirectory::create(wanted, "verify");
    write_checks(directory, results, provenance);
    say("{}", checks_text(results, provenance, output_columns()));
    say("Page: {}\n", (directory.path() / "verify.html").string());
    for (const CheckResult& result : results)
        if (!result.within()) return ExitCode::numerical;
    return ExitCode::success;
}

}  // namespace feldspar
