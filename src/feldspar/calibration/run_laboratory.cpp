#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "feldspar/base/error.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/lab/properties.hpp"

namespace feldspar {
namespace {

constexpr double elastic_stress_share = 0.04;      // of the strength: where tests for E and nu before damage end
constexpr double usual_UCS_over_E = 1.0 / 210.0;   // when they are not both targets

double elastic_strain(const Calibration& calibration) {
    const double ratio = wanted_UCS_Pa(calibration.targets) / target_value("E", calibration.targets);
    return elastic_stress_share * (std::isfinite(ratio) ? ratio : usual_UCS_over_E);
}

std::string column_of(const Observable& quantity, bool elastic) {
    if (!elastic) return quantity.column;
    return quantity.name == "E" ? "E_initial_Pa" : "nu_initial";
}

}  // namespace

Run RunLaboratory::run_for(const Request& request, const Observable& quantity) const {
    const Job job = calibration_.job_with(request.values);
    for (const TestSpec& test : job.tests) {
        if (test.kind != quantity.test || (test.kind == TestKind::biaxial && test.sigma3_Pa != quantity.sigma3_Pa)) continue;
        TestSpec wanted = test;
        if (!request.whole) wanted.stop_fraction = std::max(test.stop_fraction, enough_fall);
        if (request.elastic) wanted.maximum_strain = elastic_strain(calibration_);
        return make_run(job, job.variants.front(), wanted, request.seed);
    }
    throw InputError({}, fmt::format("the job has no test for {}", quantity.name));   // was checked when the file was read
}

std::vector<std::vector<double>> RunLaboratory::see(const std::vector<Request>& requests, const std::vector<Observable>& quantities) {
    std::vector<Run> runs;
    std::vector<std::vector<std::size_t>> run_of;   // of each request's quantities
    for (const Request& request : requests) {
        std::map<std::pair<TestKind, double>, std::size_t> of_test;
        std::vector<std::size_t>& own = run_of.emplace_back();
        for (const std::size_t q : request.quantities) {
            const auto [found, fresh] = of_test.try_emplace({quantities[q].test, quantities[q].sigma3_Pa}, runs.size());
            if (fresh) runs.push_back(run_for(request, quantities[q]));
            own.push_back(found->second);
        }
    }
    for (const Run& run : runs) numbers_.try_emplace(run.id, static_cast<int>(numbers_.size()) + 1);
    left_ = execute(runs, ledger_, control_).left;
    if (left_ > 0) throw Interrupted();
    std::vector<std::vector<double>> values;
    for (std::size_t r = 0; r < requests.size(); ++r) {
        std::vector<double>& own = values.emplace_back();
        for (std::size_t i = 0; i < requests[r].quantities.size(); ++i) {
            const auto record = ledger_.find(runs[run_of[r][i]].id);
            const bool done = record && record->state == RunState::done;   // a run that fails teaches nothing
            own.push_back(done ? record->numbers.at(column_of(quantities[requests[r].quantities[i]], requests[r].elastic)) : std::nan(""));
        }
    }
    return values;
}

}  // namespace feldspar
