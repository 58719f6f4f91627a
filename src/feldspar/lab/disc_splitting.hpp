// When a Brazilian disc is split: a connected path of cracks along the loaded diameter (P26), docs/theory/properties.md.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "feldspar/methods/result.hpp"

namespace feldspar {

/// What the search needs to know of a disc. The loaded diameter lies along y.
struct LoadedDisc {
    Vec2 centre;                 ///< m
    double radius_m = 0.0;       ///< > 0
    double mean_grain_m = 0.0;   ///< mean diameter of the grains, > 0
    double flat_height_m = 0.0;  ///< of a flattened disc: of its flats from the centre; else 0

    double band_half_width_m() const;  ///< cracks whose middle is farther from the loaded diameter do not count
    double reach_m() const;            ///< cracks that are nearer to each other than this are connected
    double loaded_length_m() const { return 2.0 * (flat_height_m > 0.0 ? flat_height_m : radius_m); }  ///< between the plates
};

/// The disc of a Brazilian test; empty if the record has no specimen, or one that is no disc.
std::optional<LoadedDisc> loaded_disc(const TestResult& result);

/// Takes cracks one after the other and says when a connected path of them spans the disc. The cost of a crack does not grow with
/// the number of cracks, so that it can be asked while a test runs. What it finds does not depend on the order of cracks of one
/// step.
class SplittingCrack {
public:
    static constexpr double split_span = 0.6;  ///< of the loaded diameter (flattened: of what is left of it)

    explicit SplittingCrack(const LoadedDisc& disc);

    /// @param crack  of a step that is not before that of the crack added last
    void add(const Crack& crack);

    bool split() const { return split_step_.has_value(); }
    std::optional<long long> split_step() const { return split_step_; }  ///< step of the crack that completed the path

    /// The crack with the earliest step of the path that split the disc; without a split of the longest path so far. Empty
    /// without a crack in the band.
    std::optional<Crack> begin() const;

    /// Extent along the loaded diameter of the longest path so far, as a share of the distance between the plates.
    double span() const { return longest_ < 0 ? 0.0 : span_of(longest_); }

    template <class Archive>
    void keep(Archive& archive) {
        auto& [disc, pieces, cracks, squares, longest, split_begin, split_step] = *this;
        archive(disc, pieces, cracks, squares, longest, split_begin, split_step);
    }

private:
    struct Piece {
        Vec2 from, to;
        int parent;        // of the path it belongs to
        double low, high;  // of a root: extent of its path along y
        int earliest;      // of a root: piece of its path with the earliest step
    };
    int root(int piece);
    double span_of(int root) const { return (pieces_[root].high - pieces_[root].low) / disc_.loaded_length_m(); }
    void join(int a, int b);
    std::int64_t square(double x, double y) const;

    LoadedDisc disc_;
    std::vector<Piece> pieces_;
    std::vector<Crack> cracks_;  // of each piece
    std::unordered_map<std::int64_t, std::vector<int>> squares_;
    int longest_ = -1;  // root of the longest path
    int split_begin_ = -1;
    std::optional<long long> split_step_;
};

/// The same for all cracks of a record. Empty without a disc.
std::optional<SplittingCrack> splitting_crack(const TestResult& result);

}  // namespace feldspar
