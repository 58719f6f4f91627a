// Claims: what somebody says of a rock model, broken down into statements that a program can hold against the results of studies.
// Nothing is run here. docs/claims.md says how a claims file is written and how a verdict comes about.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "feldspar/study/point_results.hpp"
#include "feldspar/study/statistics.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// How a statement is decided. Every rule makes one number a packing, and judges the 95 % interval of their mean (decide.hpp).
enum class Rule {
    greater,            ///< first minus second, same packing: above 0
    rises_with,         ///< each step along an axis, and its ends: above 0
    falls_with,         ///< the same: below 0
    negligible,         ///< each step along an axis, and its ends: inside the bound
    matters,            ///< the ends of an axis: outside the bound
    influence_greater,  ///< relative change over an axis, first minus second, each counted positive in its mean: above 0
    linear_with,        ///< departure from the straight line through an axis' ends, as a share of the change between them: inside
    between,            ///< first from the nearer bound, second and third, both ways: above 0
    closer,             ///< distance from third minus distance from second: above 0
    above,
    below,  ///< the value, or first over second: above, below a number
    within  ///< the value, or first over second, over a number or the laboratory's value, less 1: inside the tolerance
};

const char* name(Rule rule);

/// The labels that are chosen on some axes; on the other axes every combination is compared.
using Selection = std::map<std::string, std::vector<std::string>>;

/// A property as PropertySummary names it, a number of the ledger of one kind of test ("ms_per_step of brazilian"), or a quotient
/// of two of these on the same packing.
struct Quantity {
    std::string text;  ///< as written
    std::string property;
    std::string divisor;  ///< empty if it is none
};

/// What may still be called nothing: a share of the value, or an amount of the quantity's own unit.
struct Bound {
    double size = std::numeric_limits<double>::quiet_NaN();
    bool relative = true;
};

/// One side of a comparison.
struct Side {
    Quantity quantity;
    Selection selection;   ///< one label an axis
    std::string axis;      ///< along which the side moves; empty if it stands still
    std::string from, to;  ///< labels; empty = the axis' first and last
};

/// One sentence that can be decided, as it stands in the claims file.
struct Statement {
    std::string says;
    std::string study;              ///< stem of a study file beside the claims file
    std::vector<std::string> also;  ///< studies with the same axes, shown beside it, without a vote
    Rule rule = Rule::greater;
    Side first, second;
    std::vector<Quantity> also_property;  ///< other definitions of the property, shown beside it, without a vote
    Selection third;                      ///< between, closer
    Selection where;                      ///< only these labels of the axes
    Bound bound;                          ///< negligible, matters, linear_with, within
    Bound no_difference;                  ///< a smaller one is none; not-a-number: none is looked for
    double number = std::numeric_limits<double>::quiet_NaN();  ///< above, below, within; SI
    int packings = 5;                                          ///< at least so many
    bool has_second = false;                                   ///< `second` was given
    std::string not_evaluated;                                 ///< why it cannot be decided; then there is no study
    std::map<std::string, int> lines;                          ///< of its keys in the file; "" is its head
};

struct Claim {
    std::string id;      ///< "C08"
    std::string figure;  ///< where it stands in the source
    std::string says;
    std::vector<Statement> statements;
};

/// A claims file.
struct ClaimList {
    std::filesystem::path file;
    std::string title, source;
    std::vector<Claim> claims;
};

/// Reads `folder`/claims.toml. @throws InputError naming file, line, column, key, value and what is allowed.
ClaimList read_claims(const std::filesystem::path& folder);

/// The same from text; `file` stands in for it in messages.
ClaimList parse_claims(const std::string& text, const std::filesystem::path& file);

/// A study and what the ledger has of it.
struct StudyResults {
    Study study;
    std::vector<PointResults>
        points;  ///< in the study's order; properties also hold the ledger's numbers ("ms_per_step of brazilian")
};

using StudiesByName = std::map<std::string, StudyResults>;

/// Which kinds of test a property is read from; empty for a name that is no property.
std::set<MethodId> tests_behind(const std::string& property);

/// What the job's [laboratory] says of a property, SI (degrees for angles); not-a-number if nothing.
double laboratory_value(const Job& job, const Quantity& quantity);

/// Reads the study files that the claims name, from their folder, and checks every statement against them.
/// @throws InputError for a study, axis, label or property that does not exist, at the line of the claims file
StudiesByName read_studies(const ClaimList& list);

/// Checks every statement against the axes, labels and properties of its study. @throws InputError as read_studies()
void check_claims(const ClaimList& list, const StudiesByName& studies);

/// Puts what the ledgers have into the studies. A study without a ledger has no results.
void add_results(StudiesByName& studies);

/// Adds the ledger's numbers of uniaxial, direct tension and Brazilian runs to a point's properties.
void add_run_numbers(PointResults& point, std::span<const RunRecord> records);

enum class Verdict { reproduced, contradicted, no_difference, in_part, undecided, not_run, not_evaluated };

const char* name(Verdict verdict);

/// One number a packing, and what follows from their mean.
struct Comparison {
    std::string what;       ///< the labels that are compared, in words
    std::string unit;       ///< of the interval: "MPa", "%", "deg" or nothing
    MeanInterval interval;  ///< in that unit; its count is the number of packings
    Verdict verdict = Verdict::undecided;
    double nothing = std::numeric_limits<double>::quiet_NaN();  ///< below which a difference is none, in the interval's unit
    std::optional<int> packings_to_decide{};                    ///< of one that is undecided (decide.hpp)
};

struct StatementResult {
    Statement statement;
    std::string study;
    bool votes = true;  ///< false for `also`
    Verdict verdict = Verdict::undecided;
    std::vector<Comparison> comparisons;
    int runs = 0;     ///< that bear on the statement
    int missing = 0;  ///< of these: neither done nor failed
    int failed = 0;

    int count(Verdict wanted) const;
};

struct ClaimResult {
    Claim claim;
    Verdict verdict = Verdict::undecided;
    std::vector<StatementResult> statements;
};

/// Decides a claim that check_claims() has let pass.
ClaimResult evaluate(const Claim& claim, const StudiesByName& studies);

/// One verdict for several: in part, if some are reproduced and others contradicted or without a difference; contradicted, if
/// some are and none is reproduced. Otherwise: not run, if any is; reproduced, no difference, not evaluated, only if all are;
/// else undecided.
Verdict together(std::span<const Verdict> verdicts);

/// A line for each comparison.
std::string claims_csv(std::span<const ClaimResult> results);

/// A table of the claims, and under it the statements with their numbers.
std::string claims_markdown(const ClaimList& list, std::span<const ClaimResult> results);

/// The same for the terminal.
std::string claims_text(std::span<const ClaimResult> results);

}  // namespace feldspar
