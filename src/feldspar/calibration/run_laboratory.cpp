#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "feldspar/base/error.hpp"
#include "feldspar/calibration/calibrate.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/laws/softening.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr double elastic_stress_share = 0.04;     // of the strength: where tests for E and nu before damage end
constexpr double usual_UCS_over_E = 1.0 / 210.0;  // when they are not both targets

double elastic_strain(const Calibration& calibration) {
    const double ratio = wanted_UCS_Pa(calibration.targets) / target_value("E", calibration.targets);
    return elastic_stress_share * (std::isfinite(ratio) ? ratio : usual_UCS_over_E);
}

std::string column_of(const Observable& quantity, bool elastic) {
    if (!elastic) return quantity.column;
    return quantity.name == "E" ? "E_initial_Pa" : "nu_initial";
}

constexpr double within_90 = 1.645;  // standard deviations of a normal error in which nine of ten lie

// In a direction: by its law, or because there is less fracture energy than elastic energy at the strength.
bool breaks_brittly(const ContactMaterial& contact) {
    const double ks = contact.eta * contact.Kn_Pa_m;
    return SofteningEnvelope::make(contact.law, contact.sigma_nt_Pa, contact.Kn_Pa_m, contact.Gfn_J_m2).brittle ||
           (ks > 0.0 && SofteningEnvelope::make(contact.law, contact.tau_Pa, ks, contact.Gfs_J_m2).brittle);
}

double number_in(const RunRecord& record, const std::string& column) {
    const auto found = record.numbers.find(column);
    return found == record.numbers.end() ? std::nan("") : found->second;
}

}  // namespace

RunReading reading_of(const RunRecord& record, const Observable& quantity, bool elastic, bool brittle) {
    RunReading reading;
    reading.grade = 'x';
    if (record.state != RunState::done) return reading;
    const double value = number_in(record, column_of(quantity, elastic));
    if (elastic) return {value};
    const auto grade = record.texts.find("grade");
    reading.grade = grade == record.texts.end() || grade->second.empty() ? 'C' : grade->second.front();
    const bool strength = quantity.column == strength_column, known = number_in(record, "peak_reached") == 1.0;
    const double error = number_in(record, "error_estimate");
    if (reading.grade == 'C') {  // what is read at a share of such a strength, or of one that was not reached, says nothing
        if (strength && known && !brittle && error > grade_b_error) {
            reading.value = value;
            reading.says = Says::at_most;
        }
        return reading;
    }
    if (!known) {
        if (strength) {
            reading.value = value;
            reading.says = Says::at_least;
        }
        return reading;
    }
    reading.value = value;
    if (quantity.name != "E" && quantity.name != "nu" && std::isfinite(error))
        reading.error = error_bound(error) / within_90;  // E and nu hardly depend on where half of the strength is
    return reading;
}

Run RunLaboratory::run_for(const Request& request, const Observable& quantity) const {
    const Job job = calibration_.job_with(request.values);
    for (const TestSpec& test : job.tests) {
        if (test.kind != quantity.test || (method_of(test).specimen.confined && test.sigma3_Pa != quantity.sigma3_Pa)) continue;
        TestSpec wanted = test;
        if (!request.whole) end_when_known(wanted);
        if (request.elastic) wanted.maximum_strain = elastic_strain(calibration_);
        return make_run(job, job.variants.front(), wanted, request.seed);
    }
    throw InputError({}, fmt::format("the job has no test for {}", quantity.name));  // was checked when the file was read
}

// The strength is known when the stress falls, and known well enough when it is far above what is wanted.
void RunLaboratory::end_when_known(TestSpec& test) const {
    test.stop_fraction = std::max(test.stop_fraction, enough_fall);
    const double wanted = far_from_wanted * wanted_strength_Pa(test, calibration_.targets);
    if (std::isfinite(wanted)) test.maximum_stress_Pa = std::min(wanted, test.maximum_stress_Pa.value_or(wanted));
}

std::vector<std::vector<RunReading>> RunLaboratory::see(const std::vector<Request>& requests,
                                                        const std::vector<Observable>& quantities) {
    std::vector<Run> runs;
    std::vector<std::vector<std::size_t>> run_of;  // of each request's quantities
    for (const Request& request : requests) {
        std::map<std::pair<MethodId, double>, std::size_t> of_test;
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
    std::vector<std::vector<RunReading>> readings;
    for (std::size_t r = 0; r < requests.size(); ++r) {
        std::vector<RunReading>& own = readings.emplace_back();
        for (std::size_t i = 0; i < requests[r].quantities.size(); ++i) {
            const auto record = ledger_.find(runs[run_of[r][i]].id);
            const Run& run = runs[run_of[r][i]];
            const bool brittle = breaks_brittly(run.job.variants.front().contact);
            own.push_back(
                reading_of(record.value_or(RunRecord{}), quantities[requests[r].quantities[i]], requests[r].elastic, brittle));
        }
    }
    return readings;
}

}  // namespace feldspar
