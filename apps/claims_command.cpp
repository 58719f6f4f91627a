#include <fmt/format.h>

#include <algorithm>

#include "commands.hpp"
#include "feldspar/findings/claims.hpp"
#include "feldspar/study/report_json.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

/// The claims that the command line names, in the file's order. @throws InputError for an id that no claim has
std::vector<Claim> chosen(const ClaimList& list, const std::vector<std::string>& ids) {
    for (const std::string& id : ids)
        if (std::none_of(list.claims.begin(), list.claims.end(), [&](const Claim& claim) { return claim.id == id; }))
            throw InputError({list.file.string(), 0, 0, "claim"}, "there is no claim '" + id + "'", "an id of the file");
    std::vector<Claim> claims;
    for (const Claim& claim : list.claims)
        if (ids.empty() || std::find(ids.begin(), ids.end(), claim.id) != ids.end()) claims.push_back(claim);
    return claims;
}

}  // namespace

ExitCode claims_command(const ClaimsOptions& options) {
    const ClaimList list = read_claims(options.folder);
    const std::vector<Claim> claims = chosen(list, options.claims);
    StudiesByName studies = read_studies(list);
    if (options.results)
        for (auto& [stem, results] : studies) results.study.results = *options.results;
    add_results(studies);
    std::vector<ClaimResult> results;
    for (const Claim& claim : claims) results.push_back(evaluate(claim, studies));
    say("{}", claims_text(results));
    if (options.csv) write_beside(*options.csv, claims_csv(results));
    if (options.markdown) write_beside(*options.markdown, claims_markdown(list, results));
    return ExitCode::success;
}

}  // namespace feldspar
