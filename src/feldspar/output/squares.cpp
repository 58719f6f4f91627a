#include "feldspar/output/squares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "feldspar/geometry/polygon.hpp"

namespace feldspar {
namespace {

// A square is drawn if so much of it is rock.
constexpr double kCovered = 0.4;

class SquareGrid {
public:
    SquareGrid(const GrainMesh& mesh, std::size_t count) : mesh_(mesh), box_(bounding_box(mesh.nodes)) {
        area_of_triangle_.reserve(mesh.triangles.size());
        double area = 0.0;
        for (const auto& [i, j, k] : mesh.triangles) {
            area_of_triangle_.push_back(0.5 * cross(mesh.nodes[j] - mesh.nodes[i], mesh.nodes[k] - mesh.nodes[i]));
            area += area_of_triangle_.back();
        }
        const Vec2 size = box_.upper - box_.lower;
        side_ = std::sqrt(area / static_cast<double>(count));
        columns_ = std::max(1, static_cast<int>(std::ceil(size.x / side_ - 1e-9)));
        rows_ = std::max(1, static_cast<int>(std::ceil(size.y / side_ - 1e-9)));
        corner_ = box_.lower - 0.5 * (Vec2{columns_ * side_, rows_ * side_} - size);

        std::vector<double> covered(static_cast<std::size_t>(columns_) * rows_, 0.0);
        place_of_triangle_.reserve(mesh.triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& [i, j, k] = mesh.triangles[t];
            place_of_triangle_.push_back(place_of((1.0 / 3.0) * (mesh.nodes[i] + mesh.nodes[j] + mesh.nodes[k])));
            covered[place_of_triangle_[t]] += area_of_triangle_[t];
        }
        square_at_.assign(covered.size(), -1);
        for (std::size_t place = 0; place < covered.size(); ++place) {
            if (covered[place] < kCovered * side_ * side_) continue;
            square_at_[place] = static_cast<int>(places_.size());
            places_.push_back(static_cast<int>(place));
            area_.push_back(covered[place]);
        }
    }

    double side() const { return side_; }
    std::size_t count() const { return places_.size(); }
    int square_of_triangle(std::size_t t) const { return square_at_[place_of_triangle_[t]]; }
    int square_at(Vec2 x) const { return square_at_[place_of(x)]; }

    GrainMesh mesh() const {
        GrainMesh squares;
        const auto n = static_cast<int>(count());
        for (int s = 0; s <= n; ++s) {
            squares.node_begin.push_back(4 * s);
            squares.triangle_begin.push_back(2 * s);
        }
        squares.vertex_count.assign(count(), 4);
        for (int s = 0; s < n; ++s) {
            for (const auto& [column, row] : corners_of(s))
                squares.nodes.push_back(corner_ + side_ * Vec2{1.0 * column, 1.0 * row});
            squares.triangles.push_back({4 * s, 4 * s + 1, 4 * s + 2});
            squares.triangles.push_back({4 * s, 4 * s + 2, 4 * s + 3});
        }
        return squares;
    }

    /// Means by area of a quantity of the triangles, twice a square: its two triangles.
    template <class Number>
    std::vector<Number> means(const std::vector<Number>& of_triangles) const {
        std::vector<double> sums(count(), 0.0);
        for (std::size_t t = 0; t < of_triangles.size(); ++t)
            if (const int s = square_of_triangle(t); s >= 0)
                sums[s] += area_of_triangle_[t] * static_cast<double>(of_triangles[t]);
        std::vector<Number> twice;
        twice.reserve(2 * count());
        for (std::size_t s = 0; s < count(); ++s) twice.insert(twice.end(), 2, static_cast<Number>(sums[s] / area_[s]));
        return twice;
    }

    /// At the corners of all squares, four a square: means by area over the squares around.
    std::vector<Vec2> at_corners(const std::vector<Vec2>& of_nodes) const {
        struct Sum {
            Vec2 value;
            double area = 0.0;
        };
        std::vector<Sum> sums(square_at_.size());
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto& [i, j, k] = mesh_.triangles[t];
            Sum& sum = sums[place_of_triangle_[t]];
            sum.value += (area_of_triangle_[t] / 3.0) * (of_nodes[i] + of_nodes[j] + of_nodes[k]);
            sum.area += area_of_triangle_[t];
        }
        std::vector<Vec2> corners;
        corners.reserve(4 * count());
        for (int s = 0; s < static_cast<int>(count()); ++s)
            for (const auto& [column, row] : corners_of(s)) {
                Sum around;
                for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row); ++r)
                    for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column); ++c) {
                        around.value += sums[static_cast<std::size_t>(r) * columns_ + c].value;
                        around.area += sums[static_cast<std::size_t>(r) * columns_ + c].area;
                    }
                corners.push_back(around.area > 0.0 ? (1.0 / around.area) * around.value : Vec2{});
            }
        return corners;
    }

    /// Of each square the mineral with the largest area.
    std::vector<int> phases(const std::vector<int>& of_grains, std::size_t minerals) const {
        std::vector<double> area(count() * minerals, 0.0);
        for (std::size_t g = 0; g < of_grains.size(); ++g)
            for (int t = mesh_.triangle_begin[g]; t < mesh_.triangle_begin[g + 1]; ++t)
                if (const int s = square_of_triangle(static_cast<std::size_t>(t)); s >= 0)
                    area[static_cast<std::size_t>(s) * minerals + of_grains[g]] += area_of_triangle_[t];
        std::vector<int> list;
        for (std::size_t s = 0; s < count(); ++s) {
            const auto begin = area.begin() + static_cast<std::ptrdiff_t>(s * minerals);
            list.push_back(static_cast<int>(std::max_element(begin, begin + static_cast<std::ptrdiff_t>(minerals)) - begin));
        }
        return list;
    }

private:
    std::size_t place_of(Vec2 x) const {
        const auto step = [&](double along, int steps) { return std::clamp(static_cast<int>(along / side_), 0, steps - 1); };
        return static_cast<std::size_t>(step(x.y - corner_.y, rows_)) * columns_ + step(x.x - corner_.x, columns_);
    }
    // Column and row of the corners of a square, counter-clockwise.
    std::array<std::pair<int, int>, 4> corners_of(int square) const {
        const int column = places_[square] % columns_, row = places_[square] / columns_;
        return {{{column, row}, {column + 1, row}, {column + 1, row + 1}, {column, row + 1}}};
    }

    const GrainMesh& mesh_;
    Box box_;
    double side_ = 0.0;
    int columns_ = 0, rows_ = 0;
    Vec2 corner_;  // lower left one of the grid
    std::vector<double> area_of_triangle_;
    std::vector<std::size_t> place_of_triangle_;
    std::vector<int> square_at_;  // of each place of the grid: the square, or -1
    std::vector<int> places_;     // of each square
    std::vector<double> area_;    // of rock in each square
};

}  // namespace

Squares in_squares(const TestResult& result, std::size_t count) {
    const GrainMesh& mesh = result.specimen->mesh;
    const SquareGrid grid(mesh, count);
    Squares squares;
    squares.side_m = grid.side();
    squares.grains_in_one =
        static_cast<double>(mesh.vertex_count.size()) / static_cast<double>(std::max<std::size_t>(1, grid.count()));
    TestResult& drawn = squares.result;
    auto specimen = std::make_shared<Specimen>();
    specimen->mesh = grid.mesh();
    drawn.specimen = std::move(specimen);
    drawn.rock = result.rock;
    drawn.texture.joint_edges = result.texture.joint_edges;
    if (!result.texture.phase_of_grain.empty())
        drawn.texture.phase_of_grain = grid.phases(result.texture.phase_of_grain, result.rock.minerals.phases.size());
    for (const Snapshot& snapshot : result.snapshots) {
        Snapshot s;
        s.label = snapshot.label;
        s.axial_strain = snapshot.axial_strain;
        s.axial_stress_Pa = snapshot.axial_stress_Pa;
        s.cracks = snapshot.cracks;
        s.displacement_m = grid.at_corners(snapshot.displacement_m);
        s.stress_xx_Pa = grid.means(snapshot.stress_xx_Pa);
        s.stress_yy_Pa = grid.means(snapshot.stress_yy_Pa);
        s.stress_xy_Pa = grid.means(snapshot.stress_xy_Pa);
        s.damage = grid.means(snapshot.damage);
        drawn.snapshots.push_back(std::move(s));
    }
    squares.crack_every = cracks_for_one(result.cracks.size());
    for (std::size_t c = 0; c < result.cracks.size(); c += squares.crack_every) {
        drawn.cracks.push_back(result.cracks[c]);
        drawn.cracks.back().grain_a = drawn.cracks.back().grain_b = -1;  // grains are not here
        squares.square_of_crack.push_back(grid.square_at(result.cracks[c].place));
    }
    return squares;
}

}  // namespace feldspar
