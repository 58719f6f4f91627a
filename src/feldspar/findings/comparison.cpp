#include "feldspar/findings/comparison.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "feldspar/base/mean.hpp"
#include "feldspar/study/statistics.hpp"

namespace feldspar {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int most_packings = 100000;
constexpr long long most_subsets = 2000;

/// Interval and chance of a change of `mean` with this standard error.
void judge(Change& change, double standard_error, double degrees_of_freedom) {
    if (!(standard_error > 0.0)) {  // the packings agree to the last digit
        change.low = change.high = change.mean;
        change.chance = change.mean == 0.0 ? 1.0 : 0.0;
        return;
    }
    const double half = student_quantile(degrees_of_freedom) * standard_error;
    change.low = change.mean - half;
    change.high = change.mean + half;
    const boost::math::students_t student(degrees_of_freedom);
    change.chance = 2.0 * boost::math::cdf(boost::math::complement(student, std::abs(change.mean) / standard_error));
}

/// The smallest n from 2 on for which `half_width_of(n)`, which falls with n, is at most `wanted`.
template <class HalfWidth>
int smallest_count(double wanted, const HalfWidth& half_width_of) {
    if (!(wanted > 0.0) || !std::isfinite(half_width_of(2))) return most_packings;
    int low = 2, high = most_packings;
    if (half_width_of(high) > wanted) return most_packings;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (half_width_of(middle) <= wanted)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/// How many subsets of k there are of n, or `most_subsets` + 1 if that is more.
long long subset_count(int n, int k) {
    double count = 1.0;
    for (int i = 0; i < k; ++i) count = count * (n - i) / (i + 1);
    return count > static_cast<double>(most_subsets) ? most_subsets + 1 : std::llround(count);
}

/// The next subset in the order of the dictionary; false after the last.
bool next_subset(std::vector<int>& chosen, int n) {
    const int k = static_cast<int>(chosen.size());
    int i = k - 1;
    while (i >= 0 && chosen[static_cast<std::size_t>(i)] == n - k + i) --i;
    if (i < 0) return false;
    ++chosen[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < k; ++j) chosen[static_cast<std::size_t>(j)] = chosen[static_cast<std::size_t>(j - 1)] + 1;
    return true;
}

Subsample subsample(std::span<const double> values, int k, double scale) {
    const int n = static_cast<int>(values.size());
    Subsample result{k, 0.0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    double squares = 0.0;
    long long counted = 0;
    const auto take = [&](const std::vector<double>& part) {
        const MeanInterval interval = mean_interval(part);
        squares += interval.half_width() * interval.half_width();
        result.lowest = std::min(result.lowest, interval.mean / scale);
        result.highest = std::max(result.highest, interval.mean / scale);
        ++counted;
    };
    std::vector<double> part(static_cast<std::size_t>(k));
    if (subset_count(n, k) <= most_subsets) {
        std::vector<int> chosen(static_cast<std::size_t>(k));
        std::iota(chosen.begin(), chosen.end(), 0);
        do {
            for (std::size_t i = 0; i < chosen.size(); ++i) part[i] = values[static_cast<std::size_t>(chosen[i])];
            take(part);
        } while (next_subset(chosen, n));
    } else {  // runs of packings, taken with every stride, stand for all subsets
        for (int stride = 1; stride < n && counted < most_subsets; ++stride) {
            if (std::gcd(stride, n) != 1) continue;
            for (int first = 0; first < n; ++first) {
                for (int i = 0; i < k; ++i)
                    part[static_cast<std::size_t>(i)] =
                        values[static_cast<std::size_t>((first + static_cast<long long>(i) * stride) % n)];
                take(part);
            }
        }
    }
    result.half_width = std::sqrt(squares / static_cast<double>(counted)) / std::abs(scale);
    return result;
}

}  // namespace

double Change::bound() const { return std::max(std::abs(low), std::abs(high)); }

// (P24)
Change change_by_packing(const PropertyStatistics& base, const PropertyStatistics& other) {
    Change change{true, 0, nan, nan, nan, nan, nan};
    const PairedValues pairs = paired(base, other);
    std::vector<double> changes;
    for (std::size_t i = 0; i < pairs.seeds.size(); ++i)
        if (pairs.first[i] != 0.0) changes.push_back(pairs.second[i] / pairs.first[i] - 1.0);
    const MeanInterval interval = mean_interval(changes);
    change.count = interval.count;
    change.mean = interval.mean;
    if (interval.count < 2) return change;
    change.deviation = interval.standard_deviation;
    judge(change, interval.standard_deviation / std::sqrt(static_cast<double>(interval.count)), interval.count - 1.0);
    return change;
}

// (P25)
Change change_between_means(const PropertyStatistics& base, const PropertyStatistics& other) {
    Change change{false, 0, nan, nan, nan, nan, nan};
    const MeanInterval a = mean_interval(base.values), b = mean_interval(other.values);
    change.count = std::min(a.count, b.count);
    if (change.count < 1 || a.mean == 0.0) return change;
    change.mean = b.mean / a.mean - 1.0;
    if (change.count < 2) return change;
    const double scale = std::abs(a.mean);
    const double share_a = std::pow(a.standard_deviation / scale, 2) / a.count,
                 share_b = std::pow(b.standard_deviation / scale, 2) / b.count;
    const double variance = share_a + share_b;
    const double freedom = variance > 0.0
                               ? variance * variance / (share_a * share_a / (a.count - 1) + share_b * share_b / (b.count - 1))
                               : a.count + b.count - 2.0;
    change.deviation =
        std::sqrt(0.5 * (a.standard_deviation * a.standard_deviation + b.standard_deviation * b.standard_deviation)) / scale;
    judge(change, std::sqrt(variance), freedom);
    return change;
}

int packings_for_change(const Change& change, double half_width) {
    const double samples = change.by_packing ? 1.0 : 2.0;
    return smallest_count(half_width,
                          [&](int n) { return student_quantile(samples * (n - 1)) * change.deviation * std::sqrt(samples / n); });
}

int packings_for_mean(double deviation, double half_width) {
    return smallest_count(half_width,
                          [&](int n) { return student_quantile(n - 1.0) * deviation / std::sqrt(static_cast<double>(n)); });
}

std::vector<bool> stand_together(std::span<const double> chances) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < chances.size(); ++i)
        if (std::isfinite(chances[i])) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return chances[a] < chances[b]; });
    std::vector<bool> stands(chances.size(), false);
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        if (chances[order[rank]] * static_cast<double>(order.size() - rank) > 0.05) break;
        stands[order[rank]] = true;
    }
    return stands;
}

std::vector<Subsample> subsamples(std::span<const double> values) {
    std::vector<Subsample> found;
    const double scale = values.empty() ? nan : mean_of(values);
    if (!std::isfinite(scale) || scale == 0.0) return found;
    for (int k = 2; k <= static_cast<int>(values.size()); ++k) found.push_back(subsample(values, k, scale));
    return found;
}

}  // namespace feldspar
