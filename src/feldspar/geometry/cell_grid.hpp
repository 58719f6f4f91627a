// Square cells for neighbour search: who is near this point, without asking everybody.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/vec2.hpp"
#include "feldspar/geometry/polygon.hpp"

namespace feldspar {

/// Points in square cells, each cell a chain of numbers. Points may be added one by one and looked up in between; points
/// outside the box are kept in the cells at its rim. The order of a visit depends on the insertions alone.
class CellGrid {
public:
    /// @param box             where the points will lie
    /// @param cell_size       edge of a cell, about the usual search distance (> 0); enlarged where the box would need more than
    ///                        about four cells a point, because memory then counts for more
    /// @param expected_count  how many points will be inserted, about
    /// @throws NumericalError if the box or the cell is not finite
    CellGrid(const Box& box, double cell_size, std::size_t expected_count) : lower_(box.lower) {
        const Vec2 size = box.upper - box.lower;
        if (!std::isfinite(size.x) || !std::isfinite(size.y) || !std::isfinite(cell_size))
            throw NumericalError("a position is not a finite number");
        const double most_cells = 4.0 * static_cast<double>(expected_count) + 64.0;
        const double cell =
            std::max({cell_size, std::sqrt(std::max(0.0, size.x * size.y) / most_cells), std::max(size.x, size.y) / most_cells});
        inverse_ = 1.0 / cell;
        columns_ = static_cast<int>(size.x * inverse_) + 1;
        rows_ = static_cast<int>(size.y * inverse_) + 1;
        first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1);
        entries_.reserve(expected_count);
    }

    /// Forgets all points; the cells stay.
    void clear() {
        std::fill(first_.begin(), first_.end(), -1);
        entries_.clear();
    }

    /// Adds `number` at `point`.
    void insert(int number, Vec2 point) {
        int& first = first_[index(column(point.x), row(point.y))];
        entries_.push_back({number, first});
        first = static_cast<int>(entries_.size()) - 1;
    }

    /// Calls visit(number) for every point in the cells that the square of half-width `reach` around `point` touches: all
    /// points within `reach`, and some that are farther.
    template <typename Visit>
    void for_each_near(Vec2 point, double reach, Visit&& visit) const {
        for_each_in({{point.x - reach, point.y - reach}, {point.x + reach, point.y + reach}}, visit);
    }

    /// Calls visit(number) for every point in the cells that `box` touches.
    template <typename Visit>
    void for_each_in(const Box& box, Visit&& visit) const {
        const int left = column(box.lower.x), right = column(box.upper.x);
        const int bottom = row(box.lower.y), top = row(box.upper.y);
        for (int r = bottom; r <= top; ++r) {
            for (int c = left; c <= right; ++c) {
                for (int e = first_[index(c, r)]; e >= 0; e = entries_[e].next) visit(entries_[e].number);
            }
        }
    }

private:
    struct Entry {
        int number;
        int next;
    };

    int column(double x) const { return bounded((x - lower_.x) * inverse_, columns_); }
    int row(double y) const { return bounded((y - lower_.y) * inverse_, rows_); }
    // What is not a number goes into the first cell: a cell outside the grid is never touched.
    static int bounded(double position, int count) {
        const double last = static_cast<double>(count - 1);
        if (!(position > 0.0)) return 0;
        return static_cast<int>(std::min(position, last));
    }
    std::size_t index(int c, int r) const {
        return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
    }

    Vec2 lower_;
    double inverse_ = 1.0;
    int columns_ = 1;
    int rows_ = 1;
    std::vector<int> first_;
    std::vector<Entry> entries_;
};

/// Discs of any mixture of sizes: one cell grid for each class of radii (powers of two), so that a few large discs do not
/// make the search among many small ones slow.
class DiscGrid {
public:
    /// @param box    where the centres will lie
    /// @param radii  of all discs that will be inserted (> 0)
    DiscGrid(const Box& box, std::span<const double> radii) {
        if (radii.empty()) return;
        const auto [least, largest] = std::minmax_element(radii.begin(), radii.end());
        smallest_ = *least;
        const int classes = std::min(30, static_cast<int>(std::floor(std::log2(*largest / smallest_)))) + 1;
        std::vector<std::size_t> counts(static_cast<std::size_t>(classes), 0);
        largest_in_class_.assign(static_cast<std::size_t>(classes), 0.0);
        for (const double r : radii) {
            const std::size_t c = class_of(r);
            class_.push_back(static_cast<unsigned char>(c));
            ++counts[c];
            largest_in_class_[c] = std::max(largest_in_class_[c], r);
        }
        for (std::size_t c = 0; c < counts.size(); ++c) {
            grids_.emplace_back(box, 2.0 * (counts[c] > 0 ? largest_in_class_[c] : *largest), counts[c]);
        }
    }

    /// Adds disc `number` (an index into the radii) at `centre`.
    void insert(int number, Vec2 centre) { grids_[class_[static_cast<std::size_t>(number)]].insert(number, centre); }

    /// Forgets all discs; the cells stay.
    void clear() {
        for (CellGrid& grid : grids_) grid.clear();
    }

    /// Calls visit(number) for every inserted disc whose rim may lie within `reach` of `point`, and for some farther ones.
    template <typename Visit>
    void for_each_near(Vec2 point, double reach, Visit&& visit) const {
        for (std::size_t c = 0; c < grids_.size(); ++c) {
            if (largest_in_class_[c] > 0.0) grids_[c].for_each_near(point, reach + largest_in_class_[c], visit);
        }
    }

private:
    std::size_t class_of(double radius) const {
        const double octave = std::floor(std::log2(radius / smallest_));
        return static_cast<std::size_t>(std::clamp(octave, 0.0, static_cast<double>(largest_in_class_.size()) - 1.0));
    }

    double smallest_ = 1.0;
    std::vector<unsigned char> class_;  ///< of each disc
    std::vector<double> largest_in_class_;
    std::vector<CellGrid> grids_;
};

}  // namespace feldspar
