// Specimens as they are made from outline, grain sizes and seed: every stage's product as a hash, so that the first stage that
// moved is seen. Recorded (golden.hpp).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <set>
#include <string>
#include <vector>

#include "../verification/fixtures.hpp"
#include "golden.hpp"

namespace feldspar {
namespace {

// XXH3 of a list of numbers.
class Numbers {
public:
    Numbers& add(double value) {
        values_.push_back(value);
        return *this;
    }
    Numbers& add(Vec2 value) { return add(value.x).add(value.y); }
    template <class List>
    requires requires(const List& list) { list.begin(); }
    Numbers& add(const List& list) {
        add(static_cast<double>(list.size()));
        for (const auto& item : list) add(item);
        return *this;
    }
    std::string hash() const {
        return fmt::format("{:016x}", static_cast<std::uint64_t>(XXH3_64bits(values_.data(), values_.size() * sizeof(double))));
    }

private:
    std::vector<double> values_;
};

std::string hashes(const Specimen& s) {
    Numbers packing, cells, mesh, filling;
    packing.add(s.packing.centres).add(s.packing.radii_m);
    cells.add(s.cells.vertices);
    for (const Cell& cell : s.cells.cells) cells.add(cell.vertices).add(cell.neighbours).add(cell.outline_edges);
    mesh.add(s.mesh.nodes).add(s.mesh.triangles).add(s.mesh.edge_triangle);
    filling.add(s.filling.centres).add(s.filling.radii_m);
    for (const InsideContact& c : s.filling.inside) filling.add(c.a).add(c.b);
    for (const AcrossContact& c : s.filling.across) filling.add(c.a).add(c.b).add(c.from).add(c.to);
    for (const OutlineShare& o : s.filling.outline) filling.add(o.particle).add(o.from).add(o.to);
    return fmt::format("{},{},{},{},{},{}", s.quality.grains, s.quality.inner_particles, packing.hash(), cells.hash(),
                       mesh.hash(), filling.hash());
}

TEST(Specimens, AreThoseRecorded) {
    std::vector<std::pair<std::string, SpecimenSpec>> specs{{"rectangle uniform", fixtures::rectangle(0.02, 0.04)},
                                                            {"disc uniform", fixtures::disc(0.03)}};
    SpecimenSpec spec = fixtures::rectangle(0.02, 0.04);
    spec.grain_sizes = {.kind = GrainSizeKind::log_normal,
                        .minimum_m = 0.0015,
                        .maximum_m = 0.004,
                        .median_m = 0.0025,
                        .log_standard_deviation = 0.3,
                        .sieve = {}};
    specs.emplace_back("rectangle log-normal", spec);
    spec.grain_sizes = {.kind = GrainSizeKind::sieve, .sieve = {{0.0015, 0.0}, {0.0025, 0.4}, {0.004, 1.0}}};
    specs.emplace_back("rectangle sieve", spec);
    spec = fixtures::rectangle(0.02, 0.04);
    spec.particles_per_grain = 26.36;
    specs.emplace_back("rectangle filled", spec);
    spec.particles_per_grain = 0.0;
    spec.triangles_per_grain = 40;
    spec.merge_length_m = 0.0;
    specs.emplace_back("rectangle finely meshed not merged", spec);
    spec = fixtures::rectangle(0.0, 0.0);
    spec.outline.shape = Shape::polygon;
    spec.outline.vertices_m = {
        {0.0, 0.0}, {0.03, 0.0}, {0.03, 0.02}, {0.02, 0.012}, {0.0, 0.03}};  // with a corner that points inwards
    specs.emplace_back("polygon uniform", spec);
    golden::File recorded("specimens.csv", golden::File::Kind::table, "grains,particles,packing,cells,mesh,filling");
    std::set<std::string> keys;
    for (const auto& [name, each] : specs)
        for (const std::uint64_t seed : {1, 2}) {
            const std::string key = fmt::format("{} seed {}", name, seed);
            keys.insert(key);
            recorded.expect(key, hashes(make_specimen(each, seed)));
        }
    recorded.expect_only(keys);
}

}  // namespace
}  // namespace feldspar
