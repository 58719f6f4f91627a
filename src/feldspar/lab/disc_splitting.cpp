#include "feldspar/lab/disc_splitting.hpp"

#include <algorithm>
#include <cmath>

#include "feldspar/geometry/segments.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

// Half the width of the central band (P26). A path along grain edges departs from a straight line by a grain to either side and
// starts beside the axis by as much: two grains. In a disc of many grains the stress decides: within 0.1 D of the axis the
// tension across the loaded diameter is at least 0.85 of that in the centre, ((1 - x^2)/(1 + x^2))^2 with x = 0.2 R.
constexpr double band_of_diameter = 0.10;
constexpr double band_of_grains = 2.0;

// The cracks of neighbouring grain edges meet at a shared vertex, and those of one edge end where the next begins. What is left
// open is an end point of an edge that has not broken: a sixth of an edge, some 0.1 of a grain. A middle that holds (0.4 of a
// grain) is a bridge and must not be passed over.
constexpr double reach_of_grain = 0.25;

}  // namespace

double LoadedDisc::band_half_width_m() const {
    return std::max(band_of_diameter * 2.0 * radius_m, band_of_grains * mean_grain_m);
}
double LoadedDisc::reach_m() const { return reach_of_grain * mean_grain_m; }

std::optional<LoadedDisc> loaded_disc(const TestResult& result) {
    if (method_of(result.test).reading != Reading::disc || !result.specimen || !result.specimen->outline.is_disc)
        return std::nullopt;
    const Outline& outline = result.specimen->outline;
    const LoadedDisc disc{outline.centre, outline.radius_m, result.specimen->quality.mean_diameter_m, outline.flat_height_m};
    if (!(disc.radius_m > 0.0) || !(disc.mean_grain_m > 0.0)) return std::nullopt;
    return disc;
}

SplittingCrack::SplittingCrack(const LoadedDisc& disc) : disc_(disc) {}

std::int64_t SplittingCrack::square(double x, double y) const {
    return std::int64_t{static_cast<std::int32_t>(std::floor(x / disc_.mean_grain_m))} * (std::int64_t{1} << 32) +
           static_cast<std::int32_t>(std::floor(y / disc_.mean_grain_m));
}

int SplittingCrack::root(int piece) {
    while (pieces_[piece].parent != piece) piece = pieces_[piece].parent = pieces_[pieces_[piece].parent].parent;
    return piece;
}

void SplittingCrack::join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    Piece &kept = pieces_[a], &gone = pieces_[b];
    gone.parent = a;
    kept.low = std::min(kept.low, gone.low);
    kept.high = std::max(kept.high, gone.high);
    if (cracks_[gone.earliest].step < cracks_[kept.earliest].step) kept.earliest = gone.earliest;
}

void SplittingCrack::add(const Crack& crack) {
    const Vec2 from = crack.from - disc_.centre, to = crack.to - disc_.centre;
    if (std::abs(0.5 * (from.x + to.x)) > disc_.band_half_width_m()) return;
    const int piece = static_cast<int>(pieces_.size());
    pieces_.push_back({from, to, piece, std::min(from.y, to.y), std::max(from.y, to.y), piece});
    cracks_.push_back(crack);
    const double reach = disc_.reach_m(), size = disc_.mean_grain_m;
    // Every square that the crack, widened by half the reach, may touch: two connected cracks share one.
    const double left = std::min(from.x, to.x) - 0.5 * reach, right = std::max(from.x, to.x) + 0.5 * reach;
    const double low = std::min(from.y, to.y) - 0.5 * reach, high = std::max(from.y, to.y) + 0.5 * reach;
    for (double i = std::floor(left / size); i <= std::floor(right / size); ++i)
        for (double j = std::floor(low / size); j <= std::floor(high / size); ++j) {
            std::vector<int>& here = squares_[square((i + 0.5) * size, (j + 0.5) * size)];
            for (const int other : here)
                if (root(other) != root(piece) &&
                    distance_between_segments(from, to, pieces_[other].from, pieces_[other].to) <= reach)
                    join(other, piece);
            here.push_back(piece);
        }
    const int path = root(piece);
    if (longest_ >= 0) longest_ = root(longest_);
    if (longest_ < 0 || span_of(path) > span_of(longest_)) longest_ = path;
    if (!split_step_ && span_of(path) >= split_span) {
        split_step_ = crack.step;
        split_begin_ = pieces_[path].earliest;
    }
}

std::optional<Crack> SplittingCrack::begin() const {
    if (longest_ < 0) return std::nullopt;
    return cracks_[split_begin_ >= 0 ? split_begin_ : pieces_[longest_].earliest];
}

std::optional<SplittingCrack> splitting_crack(const TestResult& result) {
    const std::optional<LoadedDisc> disc = loaded_disc(result);
    if (!disc) return std::nullopt;
    std::vector<const Crack*> cracks;
    for (const Crack& crack : result.cracks) cracks.push_back(&crack);
    std::stable_sort(cracks.begin(), cracks.end(), [](const Crack* a, const Crack* b) { return a->step < b->step; });
    SplittingCrack splitting(*disc);
    for (const Crack* crack : cracks) splitting.add(*crack);
    return splitting;
}

}  // namespace feldspar
