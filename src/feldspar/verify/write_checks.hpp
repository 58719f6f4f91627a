// What checks found, for a reader: as text, as a page, and for other programs.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "feldspar/output/results.hpp"
#include "feldspar/verify/run_checks.hpp"

namespace feldspar {

/// "96 of 96 within their bounds".
std::string tally(std::span<const CheckResult> results);

/// The table of a terminal: a row a comparison, topic by topic, then what failed and why, and the tally.
/// @param columns  of the terminal; 0: of no terminal
std::string checks_text(std::span<const CheckResult> results, const Provenance& provenance, std::size_t columns = 0);

/// What there is to check: names and sentences, topic by topic. @param filter  may be empty: all
std::string checks_list(const std::vector<Topic>& topics, const std::function<bool(const Check&)>& filter,
                        std::size_t columns = 0);

/// verify.html, verify.json and verify.md. @throws OutputError
void write_checks(const RunDirectory& directory, std::span<const CheckResult> results, const Provenance& provenance);

}  // namespace feldspar
