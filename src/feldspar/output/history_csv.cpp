// A test's history as CSV. Nothing in it depends on the time of day, the wall time or the number of threads: two runs of the
// same job give the same bytes.
#include <fmt/format.h>

#include <iterator>
#include <string>

#include "feldspar/base/printable.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/output/history_columns.hpp"
#include "feldspar/output/results.hpp"
#include "feldspar/output/user_units.hpp"

namespace feldspar {

namespace {

std::string header(const TestResult& result, const Provenance& provenance) {
    std::string text;
    auto line = std::back_inserter(text);
    fmt::format_to(line, "# history of {}, seed {}", test_name(result.test), result.seed);
    if (tells_pressure(result.test)) fmt::format_to(line, ", {} {:.6g} MPa", pressure_key(method_of(result.test)), result.test.sigma3_Pa * MPa);
    if (!result.variant.empty()) fmt::format_to(line, "\n# variant: {}", printable(result.variant, LineEnds::escaped));
    fmt::format_to(line, "\n# signs: {}\n", sign_convention);
    fmt::format_to(line, "# model: {} grains, contact {}, law {}, numerics {}, plane {}\n", name(result.model.kind),
                   name(result.model.contact), name(result.contact.law), name(result.numerics.kind), name(result.model.plane));
    fmt::format_to(line, "# feldspar {}, commit {}\n# columns: name [unit] meaning\n", provenance.version, provenance.commit);
    for (const FileColumn& column : history_columns(result)) {
        fmt::format_to(line, "#   {} [{}] {}\n", column.name, column.unit, column.meaning);
    }
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
    auto out = std::back_inserter(text);
    const std::vector<FileColumn> columns = history_columns(result);
    for (std::size_t c = 0; c < columns.size(); ++c) fmt::format_to(out, "{}{}", c == 0 ? "" : ",", columns[c].name);
    text += '\n';
    for (const HistoryRow& row : result.history) {
        for (std::size_t c = 0; c < columns.size(); ++c) {
            if (c > 0) text += ',';
            const double value = columns[c].value(row);
            // {} prints the shortest decimal that reads back as the same double, whatever the locale
            if (columns[c].whole) {
                fmt::format_to(out, "{}", static_cast<long long>(value));
            } else {
                fmt::format_to(out, "{}", value);
            }
        }
        text += '\n';
    }
    directory.write_text("history-" + test_stem(result) + ".csv", text);
}

}  // namespace feldspar
