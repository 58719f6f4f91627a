// The numbers of one test, each once: name, unit, where it is defined, which tests have it, where it stands in a result and what
// files call it.
//
// What a file holds of a test is a loop over this table: the ledger (study/run_record.cpp), summary.json, the report's data.
// Properties of a rock over its packings, which are read from these numbers, have a table of their own (lab/rock_properties.hpp).
#pragma once

#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "feldspar/base/quantity_unit.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

/// Files list numbers group by group, each in its own order of groups; within a group the order is the same everywhere.
enum class QuantityGroup {
    strength,
    load,
    peak,
    elastic,
    first_crack,
    initiation,
    damage,
    post_peak,
    brazilian,
    flattened,
    of_method,
    hole,
    cycles,
    multi_stage,
    cracks,
    pattern,
    evidence,
    repeats,
    balance,
    energies,
    steps,
    bookkeeping,
    cost
};

enum class QuantityForm { real, whole, yes_no };  ///< as a number, the last is 1 or 0

/// A number's place in a result.
struct QuantityPlace {
    QuantityForm form = QuantityForm::real;
    std::function<double(const TestResult&)> of;
    std::function<void(TestResult&, double)> put{};  ///< none for what is counted or formed from the rest
};

/// One number of one test.
struct TestQuantity {
    static constexpr std::string_view same = "=", absent = "";

    std::string_view name;  ///< without unit: "E", "strength", "BTS_first_dip"
    QuantityUnit unit;
    std::string_view definition;  ///< "(P3)": where docs/theory defines it; empty for what needs no formula
    QuantityPlace place;
    std::string_view ledger = same;   ///< absent: the ledger does not have it; else it is the name
    std::string_view summary = same;  ///< its name in summary.json, without unit, or absent
    std::string_view report = same;   ///< its name in the report's data, or absent
    QuantityGroup group{};
    std::set<MethodId> tests{};  ///< that define it

    /// As it is kept; not-a-number if the test does not define it.
    double value(const TestResult& result) const;
    /// Gives back what value() had; nothing where it is counted or formed from the rest, or a count is not-a-number.
    void put(TestResult& result, double value) const;
    /// In the ledger: "E_Pa".
    std::string kept_name() const { return unit.kept_name(name); }
    /// In summary.json, if it is there: "E_GPa".
    std::string summary_name() const { return unit.user_name(summary == same ? name : summary); }
    /// In the report's data, if it is there.
    std::string report_name() const { return std::string(report == same ? name : report); }
};

/// All of them, in the ledger's order.
std::span<const TestQuantity> test_quantities();

/// The one of this name ("E"), which must exist.
const TestQuantity& test_quantity(std::string_view name);

}  // namespace feldspar
