#include "feldspar/lab/acoustic_emission.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "feldspar/base/regression.hpp"

namespace feldspar {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Constants of the rock by which a crack's displacement becomes a moment: of flexible grains theirs; else what the test has
// shown.
struct Lame {
    double lambda = nan, G = nan;
};

Lame lame_of(const TestResult& result) {
    const bool flexible = result.model.kind == GrainKind::flexible;
    const double E = flexible ? result.grain.E_Pa : result.properties.E_initial_Pa,
                 nu = flexible ? result.grain.nu : result.properties.nu_initial;
    const double G = E / (2.0 * (1.0 + nu));
    return {result.model.plane == PlaneState::strain ? 2.0 * G * nu / (1.0 - 2.0 * nu) : 2.0 * G * nu / (1.0 - nu), G};
}

// (P66) of one crack: its area, normal and the displacement of one face against the other.
Mat2 moment_of(const Crack& crack, const Lame& rock) {
    const Vec2 n = crack.normal, d = crack.opening_m * n + crack.slip_m * rot90(n);
    const double trace = rock.lambda * crack.opening_m;
    const double A = crack.area_m2;
    return {A * (trace + 2.0 * rock.G * d.x * n.x), A * rock.G * (d.x * n.y + d.y * n.x), A * rock.G * (d.x * n.y + d.y * n.x),
            A * (trace + 2.0 * rock.G * d.y * n.y)};
}

// Magnitude, moment magnitude and R, once all cracks are in.
void finish(AcousticEvent& event) {
    if (event.energy_J > 0.0) event.magnitude = 2.0 / 3.0 * (std::log10(event.energy_J) - 4.8);
    const Mat2& M = event.moment_Nm;
    const double mean = 0.5 * (M.xx + M.yy), radius = std::hypot(0.5 * (M.xx - M.yy), M.xy);
    const double scalar_Nm = std::sqrt(0.5 * ((mean + radius) * (mean + radius) + (mean - radius) * (mean - radius)));
    if (!(scalar_Nm > 0.0)) return;
    event.moment_magnitude = 2.0 / 3.0 * std::log10(scalar_Nm) - 6.07;
    event.isotropy = 100.0 * 2.0 * mean / (2.0 * std::abs(mean) + 2.0 * radius);
}

// Events that a crack may still join, in squares a little wider than the radius of an event: a crack looks at nine of them,
// however many events there are elsewhere.
class ActiveEvents {
public:
    ActiveEvents(const std::vector<AcousticEvent>& events, double radius_m, double window_steps)
        : events_(events), radius_m_(radius_m), side_m_(radius_m > 0.0 ? 1.001 * radius_m : 1.0), window_steps_(window_steps) {}

    // The event within the radius that is nearest to a crack, of equally near ones the newest; what is too old for this crack is
    // forgotten. @return its number, or nobody
    std::size_t nearest(const Crack& crack) {
        std::size_t found = nobody;
        double least = radius_m_;
        const std::int64_t column = step_of(crack.place.x), row = step_of(crack.place.y);
        for (std::int64_t r = row - 1; r <= row + 1; ++r)
            for (std::int64_t c = column - 1; c <= column + 1; ++c) {
                const auto square = squares_.find(key(c, r));
                if (square == squares_.end()) continue;
                std::erase_if(square->second, [&](std::size_t e) {
                    return static_cast<double>(crack.step - events_[e].last_step) > window_steps_;
                });
                for (const std::size_t e : square->second) {
                    const double distance = norm(crack.place - events_[e].place);
                    if (!(distance <= least) || (distance == least && found != nobody && e < found)) continue;
                    least = distance;
                    found = e;
                }
                if (square->second.empty()) squares_.erase(square);
            }
        return found;
    }
    void add(std::size_t event) { squares_[square_of(event)].push_back(event); }
    void remove(std::size_t event) { std::erase(squares_[square_of(event)], event); }

    static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

private:
    std::int64_t step_of(double x) const { return static_cast<std::int64_t>(std::floor(x / side_m_)); }
    static std::int64_t key(std::int64_t column, std::int64_t row) { return row * (std::int64_t{1} << 32) + column; }
    std::int64_t square_of(std::size_t event) const {
        return key(step_of(events_[event].place.x), step_of(events_[event].place.y));
    }

    const std::vector<AcousticEvent>& events_;
    double radius_m_, side_m_, window_steps_;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> squares_;
};

}  // namespace

AcousticEmission events_of_cracks(const TestResult& result, double radius_grains) {
    AcousticEmission emission;
    if (!result.specimen || result.cracks.empty()) return emission;
    emission.radius_m = radius_grains * result.specimen->quality.cell_sizes.mean_m;
    emission.window_steps = emission.radius_m / result.length_m * result.travel_steps;
    const Lame rock = lame_of(result);
    ActiveEvents active(emission.events, emission.radius_m, emission.window_steps);
    for (const Crack& crack : result.cracks) {
        std::size_t joined = active.nearest(crack);
        if (joined == ActiveEvents::nobody) {
            joined = emission.events.size();
            emission.events.push_back(
                {.first_step = crack.step, .axial_strain = crack.axial_strain, .axial_stress_Pa = crack.axial_stress_Pa});
        } else {
            active.remove(joined);  // its place moves
        }
        AcousticEvent& event = emission.events[joined];
        event.last_step = crack.step;
        event.place = (1.0 / (event.cracks + 1)) * (static_cast<double>(event.cracks) * event.place + crack.place);
        ++event.cracks;
        active.add(joined);
        event.shear_cracks += crack.mode == CrackMode::shear;
        event.energy_J += crack.energy_J;
        const Mat2 m = moment_of(crack, rock);
        event.moment_Nm = {event.moment_Nm.xx + m.xx, event.moment_Nm.xy + m.xy, event.moment_Nm.yx + m.yx,
                           event.moment_Nm.yy + m.yy};
    }
    std::vector<double> magnitudes;
    for (AcousticEvent& event : emission.events) {
        finish(event);
        if (std::isfinite(event.magnitude)) magnitudes.push_back(event.magnitude);
    }
    const double completeness = magnitude_of_completeness(magnitudes);
    const BValue fit = b_value(magnitudes, completeness);
    if (fit.events >= fewest_events) emission.b_value = fit;
    return emission;
}

AcousticEmission gather_events(const TestResult& result, double radius_grains) {
    AcousticEmission emission = events_of_cracks(result, radius_grains);
    std::vector<Vec2> places;
    for (const AcousticEvent& event : emission.events) places.push_back(event.place);
    if (static_cast<int>(places.size()) >= fewest_events) emission.fractal_dimension = correlation_dimension(places);
    return emission;
}

AcousticEmission acoustic_emission(const TestResult& result) {
    AcousticEmission emission = gather_events(result, usual_event_radius);
    if (emission.events.empty()) return emission;
    for (const double radius : counted_event_radii) {
        const AcousticEmission other = radius == usual_event_radius ? emission : events_of_cracks(result, radius);
        emission.counts.push_back({radius, other.events.size(), other.b_value});
    }
    return emission;
}

double magnitude_of_completeness(const std::vector<double>& magnitudes) {
    constexpr double kBin = 0.1, kCorrection = 0.2;
    std::map<long long, int> histogram;
    for (const double m : magnitudes) ++histogram[std::llround(m / kBin)];
    const auto most =
        std::max_element(histogram.begin(), histogram.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == histogram.end() ? nan : kBin * static_cast<double>(most->first) + kCorrection;
}

BValue b_value(std::vector<double> magnitudes, double completeness, double bin) {
    std::erase_if(magnitudes, [&](double m) { return !(m >= completeness - 1e-9); });
    BValue fit;
    fit.completeness = completeness;
    fit.events = static_cast<int>(magnitudes.size());
    if (fit.events < 2) return fit;
    const double n = static_cast<double>(fit.events);
    double mean = 0.0, squares = 0.0;
    for (const double m : magnitudes) mean += m / n;
    for (const double m : magnitudes) squares += (m - mean) * (m - mean);
    const double above = mean - completeness;
    if (!(above > 0.0)) return fit;
    fit.b = bin > 0.0 ? std::log1p(bin / above) / (bin * std::numbers::ln10) : std::numbers::log10e / above;
    fit.error = std::numbers::ln10 * fit.b * fit.b * std::sqrt(squares / (n * (n - 1.0)));
    return fit;
}

double correlation_dimension(const std::vector<Vec2>& places) {
    constexpr double kFrom = 0.05, kTo = 0.30;  // of the largest distance: below a few points decide, above the specimen's edge
    constexpr std::size_t kRadii = 12, kMost = 2000;  // of more places every n-th, as the pairs grow with the square
    std::vector<Vec2> sample(std::min(places.size(), kMost));
    for (std::size_t i = 0; i < sample.size(); ++i) sample[i] = places[i * places.size() / sample.size()];
    const auto for_each_distance = [&](auto visit) {
        for (std::size_t i = 0; i < sample.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec2 d = sample[i] - sample[j];
                visit(dot(d, d));
            }
    };
    double largest = 0.0;
    for_each_distance([&](double squared) { largest = std::max(largest, squared); });
    std::array<double, kRadii> r{};
    for (std::size_t k = 0; k < kRadii; ++k)
        r[k] = std::sqrt(largest) * kFrom * std::pow(kTo / kFrom, static_cast<double>(k) / (kRadii - 1));
    std::array<double, kRadii> closer{};  // pairs nearer than r[k], and not nearer than r[k - 1]
    for_each_distance([&](double squared) {
        if (squared >= r.back() * r.back()) return;
        ++closer[static_cast<std::size_t>(
            std::find_if(r.begin(), r.end(), [&](double radius) { return squared < radius * radius; }) - r.begin())];
    });
    std::partial_sum(closer.begin(), closer.end(), closer.begin());
    const double pairs = 0.5 * static_cast<double>(sample.size()) * (static_cast<double>(sample.size()) - 1.0);
    std::vector<double> log_r, log_C;
    for (std::size_t k = 0; k < kRadii; ++k) {
        if (closer[k] == 0.0) continue;
        log_r.push_back(std::log(r[k]));
        log_C.push_back(std::log(closer[k] / pairs));
    }
    return log_r.size() < 3 ? nan : regression_line(log_r, log_C).slope;
}

}  // namespace feldspar
