// A test's history as CSV. Nothing in it depends on the time of day, the wall time or the number of threads: two runs of the
// same job give the same bytes.
#include <fmt/format.h>

#include <iterator>
#include <string>

#include "feldspar/base/printable.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/csv_table.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

std::string header(const TestResult& result, const Provenance& provenance) {
    std::string text;
    auto line = std::back_inserter(text);
    fmt::format_to(line, "# history of {}, seed {}", test_name(result.test), result.seed);
    if (tells_pressure(result.test))
        fmt::format_to(line, ", {} {:.6g} MPa", pressure_key(method_of(result.test)), result.test.sigma3_Pa * MPa);
    if (!result.variant.empty()) fmt::format_to(line, "\n# variant: {}", printable(result.variant, LineEnds::escaped));
    fmt::format_to(line, "\n# format: feldspar history 1\n# signs: {}\n", sign_convention);
    fmt::format_to(line, "# model: {} grains, contact {}, law {}, numerics {}, plane {}\n", name(result.model.kind),
                   name(result.model.contact), name(result.contact.law), name(result.numerics.kind), name(result.model.plane));
    fmt::format_to(line, "# feldspar {}, commit {}\n# columns: name [unit] meaning\n", provenance.version, provenance.commit);
    append_meanings(text, history_columns(result));
    return text;
}

}  // namespace

std::string test_stem(const std::string& variant, const TestSpec& test, std::uint64_t seed) {
    std::string stem = fmt::format("{}-s{}", test_name(test), seed);
    if (tells_pressure(test)) stem += fmt::format("-p{:.6g}", test.sigma3_Pa * MPa);
    return variant.empty() ? stem : variant_stem(variant) + "-" + stem;
}

std::string test_stem(const TestResult& result) { return test_stem(result.variant, result.test, result.seed); }

void write_history_csv(const RunDirectory& directory, const TestResult& result, const Provenance& provenance) {
    std::string text = header(result, provenance);
    append_csv(text, history_columns(result), result.history);
    directory.write_text("history-" + test_stem(result) + ".csv", text);
}

}  // namespace feldspar
