#include "feldspar/model/texture.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string_view>

#include "feldspar/base/error.hpp"
#include "feldspar/base/rng.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/model/joints.hpp"
#include "feldspar/model/log_normal.hpp"
#include "feldspar/specimen/grain_sizes.hpp"

namespace feldspar {
namespace {

// Uniform in (0, 1) from the seed, the purpose and a key: the same wherever and whenever it is asked for.
double hashed_uniform(std::uint64_t seed, std::string_view purpose, std::uint64_t key) {
    const std::array<std::uint64_t, 3> words{seed, XXH3_64bits(purpose.data(), purpose.size()), key};
    const std::uint64_t bits = XXH3_64bits(words.data(), sizeof words) >> 11;  // 53 bits
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
}

double standard_normal_at(double u) { return boost::math::quantile(boost::math::normal(), u); }
double normal_share_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// A Gaussian random field of mean 0 and variance 1 whose covariance is exp(-r^2 / (2 length^2)): a sum of plane waves of random
// direction and phase.
class GaussianField {
public:
    GaussianField(std::uint64_t seed, const std::string& name, double length_m) {
        constexpr int kWaves = 600;  // kurtosis of the sum: 3 - 1.5 / 600
        RandomStream random(seed, name);
        for (int i = 0; i < kWaves; ++i) {
            const double kx = random.normal() / length_m, ky = random.normal() / length_m;
            waves_.push_back({{kx, ky}, random.uniform(0.0, 2.0 * std::numbers::pi)});
        }
    }
    double operator()(Vec2 x) const {
        double sum = 0.0;
        for (const Wave& wave : waves_) sum += std::cos(dot(wave.k, x) + wave.phase);
        return sum * std::sqrt(2.0 / static_cast<double>(waves_.size()));
    }

private:
    struct Wave {
        Vec2 k;
        double phase;
    };
    std::vector<Wave> waves_;
};

// Share of the distribution below a factor.
double share_below(const Distribution& d, double f) {
    if (!(f > 0.0) && d.kind != DistributionKind::normal) return 0.0;
    if (std::isinf(f)) return f > 0.0 ? 1.0 : 0.0;
    switch (d.kind) {
        case DistributionKind::weibull:
            return -std::expm1(-std::pow(f * std::tgamma(1.0 + 1.0 / d.weibull_modulus), d.weibull_modulus));
        case DistributionKind::log_normal: {
            const double s = log_deviation(d.variation);
            return normal_share_below((std::log(f) + 0.5 * s * s) / s);
        }
        case DistributionKind::normal:
            return normal_share_below((f - 1.0) / d.variation);
        case DistributionKind::none:
            break;
    }
    return f >= 1.0 ? 1.0 : 0.0;
}

std::vector<double> areas_of_cells(const Specimen& specimen) {
    std::vector<double> areas;
    for (int c = 0; c < std::ssize(specimen.cells.cells); ++c) areas.push_back(signed_area(corners_of_cell(specimen.cells, c)));
    return areas;
}

// Gives grains, in the order given, to phases so that the areas come out as wanted: by chance, in proportion to what each phase
// still lacks.
std::vector<int> at_random(const MineralSpec& minerals, const std::vector<double>& area, const std::vector<int>& order,
                           const std::vector<double>& chance) {
    const double total = std::accumulate(area.begin(), area.end(), 0.0);
    std::vector<double> lacks;
    for (const Mineral& phase : minerals.phases) lacks.push_back(phase.share * total);
    std::vector<int> phase(area.size(), 0);
    for (const int g : order) {
        double sum = 0.0;
        for (const double lack : lacks) sum += std::max(lack, 0.0);
        double left = chance[g] * sum;
        std::size_t chosen = 0, last = 0;
        for (std::size_t p = 0; p < lacks.size(); ++p) {
            if (lacks[p] <= 0.0) continue;
            last = p;
            chosen = p;
            if (left < lacks[p]) break;
            left -= lacks[p];
        }
        if (sum <= 0.0) chosen = last = static_cast<std::size_t>(std::max_element(lacks.begin(), lacks.end()) - lacks.begin());
        phase[g] = static_cast<int>(chosen);
        lacks[chosen] -= area[g];
    }
    return phase;
}

// One phase after the other takes the grains where its own random field is highest, until it has its share; the last one takes
// the rest.
std::vector<int> in_clusters(const MineralSpec& minerals, std::uint64_t seed, const std::vector<double>& area,
                             const std::vector<Vec2>& centre) {
    const double total = std::accumulate(area.begin(), area.end(), 0.0);
    std::vector<int> phase(area.size(), static_cast<int>(minerals.phases.size()) - 1), free(area.size());
    std::iota(free.begin(), free.end(), 0);
    for (std::size_t p = 0; p + 1 < minerals.phases.size(); ++p) {
        const GaussianField field(seed, "mineral " + minerals.phases[p].name, minerals.cluster_length_m);
        std::vector<double> height(area.size());
        for (const int g : free) height[g] = field(centre[g]);
        std::stable_sort(free.begin(), free.end(), [&](int l, int r) { return height[l] > height[r]; });
        double wanted = minerals.phases[p].share * total;
        std::size_t taken = 0;
        while (taken < free.size() && wanted > 0.5 * area[free[taken]]) {
            phase[free[taken]] = static_cast<int>(p);
            wanted -= area[free[taken++]];
        }
        free.erase(free.begin(), free.begin() + static_cast<std::ptrdiff_t>(taken));
    }
    return phase;
}

bool contains(const std::vector<Vec2>& convex, Vec2 x) {
    for (std::size_t k = 0; k < convex.size(); ++k)
        if (cross(convex[(k + 1) % convex.size()] - convex[k], x - convex[k]) < 0.0) return false;
    return true;
}

// The phase that has most of a cell's pixels, of equals the first. A cell without a pixel of its own takes the one at its centre.
std::vector<int> by_map(const PhaseMap& map, const MineralSpec& minerals, const Specimen& specimen, const std::vector<int>& unit,
                        const std::vector<Vec2>& centre_of) {
    Box box = bounding_box(specimen.mesh.nodes);
    const Vec2 size = box.upper - box.lower;
    const double pixel_x = size.x / map.width, pixel_y = size.y / map.height;
    if (std::abs(pixel_x / pixel_y - 1.0) > 0.02)
        throw InputError({.key = "material.minerals.map"},
                         fmt::format("the map \"{}\" has {} x {} pixels, but the specimen is {:.4g} mm wide and {:.4g} mm high",
                                     minerals.map_file, map.width, map.height, 1e3 * size.x, 1e3 * size.y),
                         "a picture whose sides are as those of the specimen, within 2 %",
                         fmt::format("cut it to {} x {} pixels", map.width, std::lround(map.width * size.y / size.x)));
    const auto at = [&](int column, int row) { return map.phase[static_cast<std::size_t>(row) * map.width + column]; };
    std::vector<std::vector<int>> votes(centre_of.size(), std::vector<int>(minerals.phases.size(), 0));
    for (int c = 0; c < std::ssize(specimen.cells.cells); ++c) {
        const std::vector<Vec2> corners = corners_of_cell(specimen.cells, c);
        const Box of_cell = bounding_box(corners);
        const int left = std::max(0, static_cast<int>((of_cell.lower.x - box.lower.x) / pixel_x)),
                  right = std::min(map.width - 1, static_cast<int>((of_cell.upper.x - box.lower.x) / pixel_x));
        const int top = std::max(0, static_cast<int>((box.upper.y - of_cell.upper.y) / pixel_y)),
                  bottom = std::min(map.height - 1, static_cast<int>((box.upper.y - of_cell.lower.y) / pixel_y));
        for (int row = top; row <= bottom; ++row)
            for (int column = left; column <= right; ++column)
                if (contains(corners, {box.lower.x + (column + 0.5) * pixel_x, box.upper.y - (row + 0.5) * pixel_y}) &&
                    at(column, row) >= 0)
                    ++votes[unit[c]][at(column, row)];
    }
    std::vector<int> phase;
    for (std::size_t u = 0; u < votes.size(); ++u) {
        const auto most = std::max_element(votes[u].begin(), votes[u].end());
        if (*most > 0) {
            phase.push_back(static_cast<int>(most - votes[u].begin()));
            continue;
        }
        const Vec2 centre = centre_of[u];
        const int column = std::clamp(static_cast<int>((centre.x - box.lower.x) / pixel_x), 0, map.width - 1),
                  row = std::clamp(static_cast<int>((box.upper.y - centre.y) / pixel_y), 0, map.height - 1);
        if (at(column, row) < 0)
            throw InputError({.key = "material.minerals.map"},
                             fmt::format("no pixel of the map \"{}\" gives a mineral to the grain at ({:.4g} mm, {:.4g} mm)",
                                         minerals.map_file, 1e3 * centre.x, 1e3 * centre.y),
                             "a map that covers the specimen with colours of its legend");
        phase.push_back(at(column, row));
    }
    return phase;
}

}  // namespace

struct Texture::Fields {
    std::array<std::unique_ptr<GaussianField>, scattered_quantities.size()> of;
    std::vector<std::unique_ptr<JointEdges>> joints;
};

Texture::~Texture() = default;
Texture::Texture(Texture&&) noexcept = default;

Texture::Texture(const Specimen& specimen, const GrainMaterial& grain, const ContactMaterial& contact, const Heterogeneity& rock)
    : specimen_(&specimen), grain_(grain), contact_(contact), rock_(&rock), fields_(std::make_unique<Fields>()) {
    if (!rock.minerals.phases.empty()) give_phases();
    for (const Scattered quantity : scattered_quantities)
        if (const Distribution& d = rock.scatter[quantity]; d.scatters() && d.correlation_length_m > 0.0)
            fields_->of[static_cast<std::size_t>(quantity)] =
                std::make_unique<GaussianField>(specimen.seed, std::string("field of ") + name(quantity), d.correlation_length_m);
    for (const JointSpec& joint : rock.joints) fields_->joints.push_back(std::make_unique<JointEdges>(specimen, joint));
    std::vector<const JointEdges*> edges;
    for (const auto& joint : fields_->joints) edges.push_back(joint.get());
    if (!edges.empty()) require_no_loose_grain(specimen, rock.joints, edges);
}

void Texture::give_phases() {
    const MineralSpec& minerals = rock_->minerals;
    const Specimen& specimen = *specimen_;
    const int cells = static_cast<int>(specimen.cells.cells.size());
    if (!specimen.spec.phase_sizes.empty()) {  // the packing knows, since it is made of grains of their sizes
        if (specimen.spec.phase_sizes.size() != minerals.phases.size())
            throw InputError({.key = "material.phase"},
                             fmt::format("{} minerals in a specimen that is packed of {}", minerals.phases.size(),
                                         specimen.spec.phase_sizes.size()),
                             "the same minerals");
        phases_ = specimen.packing.phases;
        return;
    }
    if (!minerals.list.empty()) {
        const int discs = static_cast<int>((specimen.packed.centres.empty() ? specimen.packing : specimen.packed).centres.size()),
                  units = specimen.quality.crystals > 0 ? specimen.quality.crystals : discs;
        if (std::ssize(minerals.list) != units)
            throw InputError({.key = "material.minerals.list"},
                             fmt::format("a list of {} minerals for {} {}", minerals.list.size(), units,
                                         specimen.quality.crystals > 0 ? "crystals" : "grains"),
                             "one each, in the order of the packing");
        for (int c = 0; c < cells; ++c) phases_.push_back(minerals.list[unit_of(c)]);
        return;
    }
    // What has one mineral: a grain, or a crystal of several.
    const bool crystals = !specimen.crystal_of_cell.empty();
    std::vector<int> unit(cells);
    for (int c = 0; c < cells; ++c) unit[c] = crystals ? specimen.crystal_of_cell[c] : c;
    const std::vector<double> area = areas_of_cells(specimen);
    const auto units = static_cast<std::size_t>(crystals ? specimen.quality.crystals : cells);
    std::vector<double> area_of(units, 0.0);
    std::vector<Vec2> centre_of(units);
    std::vector<int> first(units, -1);
    for (int c = 0; c < cells; ++c) {
        area_of[unit[c]] += area[c];
        centre_of[unit[c]] += area[c] * specimen.mesh.nodes[specimen.mesh.centre_node[c]];
        if (first[unit[c]] < 0) first[unit[c]] = c;
    }
    for (std::size_t u = 0; u < units; ++u) centre_of[u] = (1.0 / area_of[u]) * centre_of[u];
    std::vector<int> phase;
    if (minerals.map) {
        phase = by_map(*minerals.map, minerals, specimen, unit, centre_of);
    } else if (minerals.cluster_length_m > 0.0) {
        phase = in_clusters(minerals, specimen.seed, area_of, centre_of);
    } else {
        std::vector<int> order(units);
        std::vector<double> turn, chance;
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t u = 0; u < units; ++u) {
            turn.push_back(hashed_uniform(specimen.seed, "turn of a grain", unit_of(first[u])));
            chance.push_back(hashed_uniform(specimen.seed, "mineral of a grain", unit_of(first[u])));
        }
        std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return turn[l] < turn[r]; });
        phase = at_random(minerals, area_of, order, chance);
    }
    for (int c = 0; c < cells; ++c) phases_.push_back(phase[unit[c]]);
}

int Texture::unit_of(int cell) const {
    return specimen_->crystal_of_cell.empty() ? disc_of(cell) : specimen_->crystal_of_cell[cell];
}

int Texture::disc_of(int cell) const {
    return specimen_->cells.disc_of_cell.empty() ? cell : specimen_->cells.disc_of_cell[cell];
}

std::uint64_t Texture::key_of(int cell_a, int cell_b) const {
    const int a = unit_of(cell_a), b = unit_of(cell_b), low = std::min(a, b), high = std::max(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

double Texture::factor(Scattered quantity, std::uint64_t key, Vec2 place) const {
    const Distribution& d = rock_->scatter[quantity];
    if (!d.scatters()) return 1.0;
    const GaussianField* field = fields_->of[static_cast<std::size_t>(quantity)].get();
    const double u = field != nullptr ? std::clamp(normal_share_below((*field)(place)), 1e-15, 1.0 - 1e-15)
                                      : hashed_uniform(specimen_->seed, name(quantity), key);
    return factor_at(d, u);
}

GrainMaterial Texture::grain(int cell) const {
    GrainMaterial grain = phases_.empty() ? grain_ : rock_->minerals.phases[phases_[cell]].grain;
    grain.E_Pa *=
        factor(Scattered::E, static_cast<std::uint64_t>(unit_of(cell)), specimen_->mesh.nodes[specimen_->mesh.centre_node[cell]]);
    return grain;
}

ContactMaterial Texture::between(int a, int b) const {
    const MineralSpec& minerals = rock_->minerals;
    const auto given = [&](int p, int q) -> const PhasePair* {
        for (const PhasePair& pair : minerals.pairs)
            if (!pair.inside && ((pair.a == p && pair.b == q) || (pair.a == q && pair.b == p))) return &pair;
        return nullptr;
    };
    if (const PhasePair* pair = given(a, b)) return pair->changes.over(contact_);
    if (a == b) return contact_;
    const ContactMaterial l = between(a, a), r = between(b, b);
    ContactMaterial m = contact_;
    const double Ks_l = l.eta * l.Kn_Pa_m, Ks_r = r.eta * r.Kn_Pa_m;
    if (minerals.unlike == UnlikeRule::mean) {
        m.Kn_Pa_m = 2.0 / (1.0 / l.Kn_Pa_m + 1.0 / r.Kn_Pa_m);  // half a boundary of each in series
        m.eta = 2.0 / (1.0 / Ks_l + 1.0 / Ks_r) / m.Kn_Pa_m;
        const auto mean = [&](double ContactMaterial::*value) { m.*value = 0.5 * (l.*value + r.*value); };
        for (const auto value : {&ContactMaterial::sigma_nt_Pa, &ContactMaterial::tau_Pa, &ContactMaterial::mu,
                                 &ContactMaterial::Gfn_J_m2, &ContactMaterial::Gfs_J_m2})
            mean(value);
    } else {
        const auto smaller = [&](double ContactMaterial::*value) { m.*value = std::min(l.*value, r.*value); };
        for (const auto value : {&ContactMaterial::Kn_Pa_m, &ContactMaterial::sigma_nt_Pa, &ContactMaterial::tau_Pa,
                                 &ContactMaterial::mu, &ContactMaterial::Gfn_J_m2, &ContactMaterial::Gfs_J_m2})
            smaller(value);
        m.eta = std::min(Ks_l, Ks_r) / m.Kn_Pa_m;
    }
    for (const auto value :
         {&ContactMaterial::sigma_nt_Pa, &ContactMaterial::tau_Pa, &ContactMaterial::Gfn_J_m2, &ContactMaterial::Gfs_J_m2})
        m.*value *= minerals.unlike_strength;
    return m;
}

ContactMaterial Texture::inside(int phase) const {
    ContactMaterial m = rock_->crystal.over(phase < 0 ? contact_ : between(phase, phase));
    for (const PhasePair& pair : rock_->minerals.pairs)
        if (pair.inside && pair.a == phase) m = pair.changes.over(m);
    return m;
}

GrainContact Texture::contact(int cell_a, int cell_b, Vec2 from, Vec2 to) const {
    GrainContact result;
    for (std::size_t j = 0; j < fields_->joints.size(); ++j)
        if (fields_->joints[j]->holds(cell_a, cell_b)) {  // the last joint that takes an edge counts
            const JointSpec& joint = rock_->joints[j];
            result = {.material = joint.contact,
                      .broken = joint.without_strength(),
                      .opening_m = joint.opening_m,
                      .joint = static_cast<std::int32_t>(j)};
        }
    if (result.joint >= 0) return result;

    ContactMaterial& m = result.material;
    result.inside = !specimen_->crystal_of_cell.empty() && unit_of(cell_a) == unit_of(cell_b);
    if (result.inside) {  // neither scatter nor initial cracks: these are of grain boundaries
        m = inside(phases_.empty() ? -1 : phases_[cell_a]);
        return result;
    }
    m = phases_.empty() ? contact_ : between(phases_[cell_a], phases_[cell_b]);
    const std::uint64_t key = key_of(cell_a, cell_b);
    const Vec2 place = 0.5 * (from + to);
    const auto drawn = [&](Scattered quantity) { return factor(quantity, key, place); };
    double strength = drawn(Scattered::strength);
    const InitialCracks& cracks = rock_->initial_cracks;
    const double u = cracks.any() ? hashed_uniform(specimen_->seed, "initial cracks", key) : 1.0;
    result.broken = u < cracks.broken;
    if (result.broken) result.opening_m = cracks.opening_m;
    result.weakened = !result.broken && u < cracks.broken + cracks.weakened;
    if (result.weakened) strength *= cracks.weakened_strength;
    const double tension = strength * drawn(Scattered::sigma_nt), shear = strength * drawn(Scattered::tau);
    m.sigma_nt_Pa *= tension;
    m.tau_Pa *= shear;
    m.Gfn_J_m2 *= std::pow(tension, rock_->scatter.energy_power) * drawn(Scattered::Gfn);
    m.Gfs_J_m2 *= std::pow(shear, rock_->scatter.energy_power) * drawn(Scattered::Gfs);
    m.mu *= drawn(Scattered::mu);
    const double stiffness = drawn(Scattered::stiffness), Ks = m.eta * m.Kn_Pa_m * stiffness * drawn(Scattered::Ks);
    m.Kn_Pa_m *= stiffness * drawn(Scattered::Kn);
    m.eta = Ks / m.Kn_Pa_m;
    return result;
}

TextureSummary Texture::summary() const {
    TextureSummary summary;
    summary.phase_of_grain = phases_;
    const MineralSpec& minerals = rock_->minerals;
    const std::vector<Cell>& cells = specimen_->cells.cells;
    if (!phases_.empty()) {
        summary.grains.assign(minerals.phases.size(), 0);
        summary.area_shares.assign(minerals.phases.size(), 0.0);
        const std::vector<double> area = areas_of_cells(*specimen_);
        const double total = std::accumulate(area.begin(), area.end(), 0.0);
        std::vector<std::vector<double>> diameters(minerals.phases.size());
        for (std::size_t c = 0; c < cells.size(); ++c) {
            ++summary.grains[phases_[c]];
            summary.area_shares[phases_[c]] += area[c] / total;
            diameters[phases_[c]].push_back(2.0 * std::sqrt(area[c] / std::numbers::pi));
        }
        for (std::vector<double>& one : diameters) summary.sizes.push_back(summary_of(std::move(one)));
        for (const PhaseFill& fill : fill_of_phases(*specimen_)) summary.disc_sizes.push_back(fill.discs);
    }
    std::map<std::pair<int, int>, int> pairs;
    std::array<std::vector<double>, scattered_quantities.size()> factors;
    summary.joint_contacts.assign(rock_->joints.size(), 0);
    summary.joint_lengths_m.assign(rock_->joints.size(), 0.0);
    const auto draw = [&](Scattered quantity, std::uint64_t key, Vec2 place) {
        if (rock_->scatter[quantity].scatters())
            factors[static_cast<std::size_t>(quantity)].push_back(factor(quantity, key, place));
    };
    for (int c = 0; c < std::ssize(cells); ++c) {
        draw(Scattered::E, static_cast<std::uint64_t>(unit_of(c)), specimen_->mesh.nodes[specimen_->mesh.centre_node[c]]);
        const int edges = static_cast<int>(cells[c].vertices.size());
        for (int k = 0; k < edges; ++k) {
            const int other = cells[c].neighbours[k];
            if (other <= c) continue;
            const Vec2 from = specimen_->cells.vertices[cells[c].vertices[k]],
                       to = specimen_->cells.vertices[cells[c].vertices[(k + 1) % edges]];
            const GrainContact made = contact(c, other, from, to);
            ++summary.contacts_in_all;
            if (made.joint >= 0) {
                ++summary.joint_contacts[made.joint];
                summary.joint_lengths_m[made.joint] += norm(to - from);
                summary.joint_edges.push_back({from, to});
                continue;
            }
            if (made.inside) {
                ++summary.inside;
                continue;
            }
            if (!phases_.empty()) {
                const auto [low, high] = std::minmax(phases_[c], phases_[other]);
                ++pairs[{low, high}];
            }
            const std::uint64_t key = key_of(c, other);
            summary.broken += made.broken;
            summary.weakened += made.weakened;
            for (const Scattered quantity : scattered_quantities)
                if (quantity != Scattered::E) draw(quantity, key, 0.5 * (from + to));
        }
    }
    summary.contacts.assign(pairs.begin(), pairs.end());
    for (const Scattered quantity : scattered_quantities) {
        const std::vector<double>& drawn = factors[static_cast<std::size_t>(quantity)];
        if (drawn.empty()) continue;
        const double n = static_cast<double>(drawn.size()), mean = std::accumulate(drawn.begin(), drawn.end(), 0.0) / n;
        double squares = 0.0;
        for (const double f : drawn) squares += (f - mean) * (f - mean);
        summary.draws.push_back({quantity, static_cast<int>(drawn.size()), mean, std::sqrt(squares / n) / mean,
                                 *std::min_element(drawn.begin(), drawn.end()), *std::max_element(drawn.begin(), drawn.end())});
    }
    return summary;
}

GrainMaterial mean_grain(const MineralSpec& minerals, const GrainMaterial& without_minerals) {
    if (minerals.phases.empty()) return without_minerals;
    GrainMaterial mean;
    double voigt = 0.0, reuss = 0.0;
    mean.density_kg_m3 = 0.0;
    for (const Mineral& phase : minerals.phases) {
        voigt += phase.share * phase.grain.E_Pa;
        reuss += phase.share / phase.grain.E_Pa;
        mean.nu += phase.share * phase.grain.nu;
        mean.density_kg_m3 += phase.share * phase.grain.density_kg_m3;
    }
    mean.E_Pa = voigt > 0.0 ? 0.5 * (voigt + 1.0 / reuss) : 0.0;
    return mean;
}

double factor_at(const Distribution& d, double u) {
    const double low = share_below(d, d.lowest), high = share_below(d, d.highest);
    const double v = low + u * (high - low);
    double factor = 1.0;
    switch (d.kind) {
        case DistributionKind::weibull:
            factor = std::pow(-std::log1p(-v), 1.0 / d.weibull_modulus) / std::tgamma(1.0 + 1.0 / d.weibull_modulus);
            break;
        case DistributionKind::log_normal:
            factor = log_normal_factor(d.variation, standard_normal_at(v));
            break;
        case DistributionKind::normal:
            factor = 1.0 + d.variation * standard_normal_at(v);
            break;
        case DistributionKind::none:
            break;
    }
    return std::clamp(factor, d.lowest, d.highest);
}

double weibull_modulus_of(double variation) {
    // ln(1 + c^2) = lgamma(1 + 2/m) - 2 lgamma(1 + 1/m) falls with m: bisection in the logarithm
    const double wanted = std::log1p(variation * variation);
    double low = std::log(0.1), high = std::log(1e4);
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high), m = std::exp(middle);
        (std::lgamma(1.0 + 2.0 / m) - 2.0 * std::lgamma(1.0 + 1.0 / m) > wanted ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

}  // namespace feldspar
