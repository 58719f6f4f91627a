#include "feldspar/verify/run_checks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <utility>

#include "feldspar/base/parallel.hpp"
#include "feldspar/base/stopwatch.hpp"

namespace feldspar {

bool CheckResult::within() const {
    return failure.empty() && !judged.empty() && std::ranges::all_of(judged, [](const Judged& j) { return j.within; });
}

const Judged* CheckResult::worst() const {
    const Judged* worst = nullptr;
    for (const Judged& j : judged)
        if (worst == nullptr || !std::isfinite(j.error) ||
            (std::isfinite(worst->error) && std::abs(j.error) > std::abs(worst->error)))
            worst = &j;
    return worst;
}

CheckResult judge(const Check& check, const char* topic, const std::vector<CheckedValue>& comparisons) {
    CheckResult result{&check, topic, {}, {}, 0.0};
    for (const CheckedValue& comparison : comparisons) {
        const double difference = comparison.found - comparison.expected,
                     error = check.bound.relative ? difference / comparison.expected : difference;
        result.judged.push_back({comparison, error, std::isfinite(error) && std::abs(error) <= check.bound.size});
    }
    return result;
}

CheckResult run_check(const Check& check, const char* topic) {
    const auto start = std::chrono::steady_clock::now();
    CheckResult result;
    try {
        result = judge(check, topic, check.compare());
    } catch (const std::exception& error) {
        result = judge(check, topic, {});
        result.failure = error.what();
    }
    result.seconds = seconds_since(start);
    return result;
}

std::vector<CheckResult> run_checks(const std::vector<Topic>& topics, const std::function<bool(const Check&)>& filter,
                                    int threads, const std::function<void(const CheckResult&)>& told) {
    std::vector<std::pair<const Check*, const char*>> chosen;
    std::vector<IndexRange> work;  // what one thread does: a check, or neighbours that stand on one computation
    for (const Topic& topic : topics)
        for (const Check& check : topic.checks) {
            if (filter && !filter(check)) continue;
            const int index = static_cast<int>(chosen.size());
            const bool joins = !chosen.empty() && !check.run.empty() && chosen.back().first->run == check.run;
            chosen.emplace_back(&check, topic.title);
            if (joins)
                work.back().end = index + 1;
            else
                work.push_back({index, index + 1});
        }
    std::vector<CheckResult> results(chosen.size());
    std::mutex telling;
    side_by_side(static_cast<int>(work.size()), threads, [&](int w) {
        for (int i = work[w].begin; i < work[w].end; ++i) {
            results[i] = run_check(*chosen[i].first, chosen[i].second);
            const std::lock_guard lock(telling);
            if (told) told(results[i]);
        }
    });
    return results;
}

}  // namespace feldspar
