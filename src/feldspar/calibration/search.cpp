#include "feldspar/calibration/search.hpp"

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <nlopt.hpp>

namespace feldspar {
namespace {

constexpr std::size_t candidates_nearby = 384;
constexpr int samples = 48;  // of what may be true, for the expected improvement
constexpr double homesickness =
    0.12;  // misfit that a parameter pays for a whole range away from home: 0.17 tolerances from the middle to an end

// A few unknowns need fewer to be looked at everywhere.
std::size_t candidates_everywhere(std::size_t dimensions) {
    return std::min<std::size_t>(1024, 128 << std::min<std::size_t>(3, dimensions));
}

// What best_point() makes small.
struct Cost {
    const Learner& learner;
    std::vector<double> home;

    double operator()(const std::vector<double>& x) const {
        double away = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) away += (x[i] - home[i]) * (x[i] - home[i]);
        return learner.at(x).misfit + homesickness * away;
    }
};

}  // namespace

std::vector<std::vector<double>> evenly(std::size_t dimensions, std::size_t count, std::size_t skip) {
    boost::random::sobol engine(dimensions);
    engine.discard(dimensions * skip);
    const double range = static_cast<double>((boost::random::sobol::max)()) + 1.0;
    std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
    for (auto& point : points)
        for (double& value : point) value = (static_cast<double>(engine()) + 0.5) / range;
    return points;
}

std::vector<double> best_point(const Learner& learner, std::size_t dimensions, std::vector<double> home) {
    if (home.empty()) home.assign(dimensions, 0.5);
    Cost cost{learner, std::move(home)};
    std::vector<std::pair<double, std::vector<double>>> ranked;
    for (std::vector<double>& x : evenly(dimensions, 2 * candidates_everywhere(dimensions), 1)) {
        const double value = cost(x);
        ranked.emplace_back(value, std::move(x));
    }
    std::partial_sort(ranked.begin(), ranked.begin() + 3, ranked.end(),
                      [](const auto& l, const auto& r) { return l.first < r.first; });
    std::pair<double, std::vector<double>> best = ranked.front();
    for (int start = 0; start < 3; ++start) {
        nlopt::opt search(nlopt::LN_SBPLX, static_cast<unsigned>(dimensions));
        search.set_lower_bounds(0.0);
        search.set_upper_bounds(1.0);
        search.set_xtol_abs(1e-4);
        search.set_maxeval(150 * static_cast<int>(dimensions));
        search.set_initial_step(0.05);
        search.set_min_objective(
            [](const std::vector<double>& x, std::vector<double>&, void* data) { return (*static_cast<const Cost*>(data))(x); },
            &cost);
        std::vector<double> x = ranked[static_cast<std::size_t>(start)].second;
        double value = 0.0;
        try {
            search.optimize(x, value);
        } catch (const nlopt::roundoff_limited&) {  // as good as it gets
            value = cost(x);
        }
        if (value < best.first) best = {value, x};
    }
    return best.second;
}

std::vector<std::vector<double>> promising_points(Learner learner, std::size_t dimensions, std::size_t count, std::size_t round) {
    boost::random::mt19937_64 engine(1000 + round);
    boost::random::normal_distribution<double> normal;
    std::vector<std::vector<double>> draws(samples, std::vector<double>(learner.quantities().size()));
    for (auto& draw : draws)
        for (double& value : draw) value = normal(engine);

    const std::size_t everywhere = candidates_everywhere(dimensions);
    std::vector<std::vector<double>> chosen;
    std::vector<double> best = best_point(learner, dimensions);
    for (std::size_t c = 0; c < count; ++c) {
        const double least = learner.at(best).misfit;
        std::vector<std::vector<double>> candidates = evenly(dimensions, everywhere, 1 + everywhere * (2 + round + c));
        candidates.push_back(best);
        for (std::size_t i = 0; i < candidates_nearby; ++i) {
            const double reach = i % 2 == 0 ? 0.03 : 0.1;
            std::vector<double> x = best;
            for (double& value : x) value = std::clamp(value + reach * normal(engine), 0.0, 1.0);
            candidates.push_back(std::move(x));
        }
        double largest = 0.0;
        std::vector<double> next = best;  // where nothing promises anything
        for (const std::vector<double>& x : candidates) {
            const Prediction prediction = learner.at(x);
            double improvement = 0.0;
            std::vector<double> values(prediction.values.size());
            for (const auto& draw : draws) {  // targets follow the quantities along their slopes
                values = prediction.values;
                for (std::size_t q = 0; q < draw.size(); ++q)
                    for (std::size_t t = 0; t < values.size(); ++t) values[t] += prediction.slopes[q][t] * draw[q];
                improvement += std::max(0.0, least - learner.misfit(values));
            }
            if (improvement > largest) {
                largest = improvement;
                next = x;
            }
        }
        chosen.push_back(next);
        learner.believe(next);
        if (learner.at(next).misfit < learner.at(best).misfit) best = next;  // surer now, and as good
    }
    return chosen;
}

}  // namespace feldspar
