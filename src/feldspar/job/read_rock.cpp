// What makes grains and contacts of [material] differ: minerals, scatter, initial cracks, joints.
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "feldspar/job/job_sections.hpp"
#include "feldspar/job/rock_files.hpp"
#include "feldspar/job/words.hpp"
#include "feldspar/model/texture.hpp"

namespace feldspar {
namespace {

constexpr std::size_t most_phases = 16;
constexpr std::array<std::uint32_t, most_phases> palette{0xd9d4c7, 0xd8a48f, 0xa9b8c9, 0x5b4a3f, 0x8fae7e, 0xc9b458,
                                                         0x7d6a9c, 0xb5656b, 0x6d9aa6, 0xe0c9a6, 0x4f6d4a, 0x9c8f7a,
                                                         0x3f5873, 0xc88bb0, 0x7a7a7a, 0x2f2f2f};

bool can_be_a_name(const std::string& name) {
    return !name.empty() && name.size() <= 40 &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

std::string read_name(const JobTable& table, const std::string& otherwise) {
    if (!table.has("name")) return otherwise;
    std::string given = table.text("name");
    table.check({"name"}, [&] {
        if (!can_be_a_name(given))
            table.fail("name", shown(*table.find("name")) + " cannot be a name here", table.allowed("name"));
    });
    return given;
}

std::filesystem::path file_of(const JobTable& table, std::string_view key) {
    const std::filesystem::path given = table.text(key);
    return given.is_absolute() ? given : std::filesystem::path(table.file()).parent_path() / given;
}

// What stands in the file that the key names. @throws InputError at the key if there is none
std::string contents_of(const JobTable& table, std::string_view key, const std::filesystem::path& file, const char* what) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored))
        table.fail(key, "there is no file " + shown(*table.find(key)), table.allowed(key));
    return read_toml_file(file, what);
}

std::uint32_t read_colour(const JobTable& table, std::uint32_t otherwise) {
    if (!table.has("colour")) return otherwise;
    const std::string given = table.text("colour");
    std::uint32_t colour = otherwise;
    table.check({"colour"}, [&] {
        const bool fits = given.size() == 7 && given.front() == '#' &&
                          std::all_of(given.begin() + 1, given.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
        if (!fits) table.fail("colour", shown(*table.find("colour")) + " is not a colour", table.allowed("colour"));
        colour = static_cast<std::uint32_t>(std::stoul(given.substr(1), nullptr, 16));
    });
    return colour;
}

class RockReader {
public:
    RockReader(const JobTable& material, const ModelSpec& model, bool model_known, int model_decided_at,
               const GrainMaterial& grain, const ContactMaterial& contact)
        : material_(material),
          model_(model),
          model_known_(model_known),
          decided_at_(model_decided_at),
          grain_(grain),
          contact_(contact) {}

    Heterogeneity read() {
        read_phases();
        read_pairs();
        read_minerals();
        if (material_.has("crystal")) rock_.crystal = read_changes(material_.table("crystal"));
        read_scatter();
        read_initial_cracks();
        read_joints();
        return std::move(rock_);
    }

private:
    void read_phases() {
        if (!material_.has("phase")) {
            for (const char* key : {"pair", "minerals"})
                if (material_.has(key))
                    material_.check({}, [&] {
                        material_.fail(key, "is given, but the rock has no minerals",
                                       "[[material.phase]] for two minerals or more");
                    });
            return;
        }
        double sum = 0.0;
        bool all_sound = true;
        const std::vector<JobTable> tables = material_.tables("phase", "a mineral");
        material_.check({"phase"}, [&] {
            if (tables.size() > most_phases)
                material_.fail("phase", fmt::format("{} minerals are too many", tables.size()), "at most 16");
        });
        for (const JobTable& table : tables) {
            table.require({"name", "share"});
            Mineral phase;
            phase.name = read_name(table, "");
            table.check({"name"}, [&] {
                for (const Mineral& other : rock_.minerals.phases)
                    if (other.name == phase.name)
                        table.fail("name", shown(*table.find("name")) + " is given twice", "each mineral a name of its own");
            });
            phase.share = table.fraction("share");
            all_sound = all_sound && table.sound({"share"});
            sum += phase.share;
            phase.grain = grain_;
            phase.grain.density_kg_m3 = table.has("density") ? table.quantity("density") : grain_.density_kg_m3;
            if (model_known_) table.suit("model.kind", name(model_.kind), decided_at_);
            if (model_known_ && model_.kind == GrainKind::flexible) {
                if (table.has("E")) phase.grain.E_Pa = table.quantity("E");
                if (table.has("nu")) phase.grain.nu = table.number("nu");
                const bool no_nu = !table.has("nu") && std::isnan(grain_.nu);
                table.check({"E"}, [&] {
                    if (!table.has("E") && !(grain_.E_Pa > 0.0))
                        table.fail("E", "missing key: E", "Young's modulus of this mineral, or E of [material.grain] for all");
                });
                table.check({"nu"}, [&] {
                    if (no_nu)
                        table.fail("nu", "missing key: nu", "Poisson's ratio of this mineral, or nu of [material.grain] for all");
                    if (model_.plane == PlaneState::strain && !(phase.grain.nu < 0.5)) table.fail("nu", "is not less than 0.5");
                });
            }
            phase.colour = read_colour(table, palette[rock_.minerals.phases.size() % most_phases]);
            if (table.has("value")) phase.value = static_cast<int>(table.integer("value"));
            if (table.has("diameter")) phase.sizes = read_grain_sizes(table, "diameter");
            rock_.minerals.phases.push_back(std::move(phase));
        }
        material_.check({"phase"}, [&] {
            if (all_sound && std::abs(sum - 1.0) > 1e-6)
                material_.fail("phase", fmt::format("the shares of the minerals add up to {:.6g}", sum), "1 (100 %)");
        });
    }

    void read_pairs() {
        if (!material_.has("pair") || rock_.minerals.phases.empty()) return;
        for (const JobTable& table : material_.tables("pair", "a pair of minerals")) {
            table.require({"phases"});
            PhasePair pair;
            std::vector<int> both;
            table.check({"phases"}, [&] {
                std::vector<std::string_view> names;
                for (const Mineral& phase : rock_.minerals.phases) names.push_back(phase.name);
                for (const toml::node& node : table.array("phases")) {
                    const std::string word = table.text_of(node, "phases");
                    const auto found = std::find(names.begin(), names.end(), word);
                    if (found == names.end())
                        table.fail_at(node, "phases", shown(node) + " is not one of the minerals", listed(names),
                                      did_you_mean(word, names));
                    both.push_back(static_cast<int>(found - names.begin()));
                }
                if (both.size() != 2) table.fail("phases", fmt::format("{} minerals make no pair", both.size()), "two names");
                pair.a = both[0];
                pair.b = both[1];
                pair.inside = table.flag("inside");
                if (pair.inside && pair.a != pair.b)
                    table.fail("inside", "two minerals have no contact inside a crystal", "one mineral with itself");
                for (const PhasePair& other : rock_.minerals.pairs)
                    if (std::minmax(other.a, other.b) == std::minmax(pair.a, pair.b) && other.inside == pair.inside)
                        table.fail("phases", "the pair is given twice", "each pair once");
            });
            pair.changes = read_changes(table);
            rock_.minerals.pairs.push_back(pair);
        }
    }

    ContactChanges read_changes(const JobTable& table) const {
        ContactChanges c;
        for (const auto& [key, value] :
             {std::pair{"Kn", &c.Kn_Pa_m}, std::pair{"sigma_nt", &c.sigma_nt_Pa}, std::pair{"tau", &c.tau_Pa},
              std::pair{"Gfn", &c.Gfn_J_m2}, std::pair{"Gfs", &c.Gfs_J_m2}})
            if (table.has(key)) *value = table.quantity(key);
        if (table.has("eta")) c.eta = table.number("eta");
        c.mu = read_friction(table);
        if (contact_.law == ContactLaw::brittle) table.refuse({"Gfn", "Gfs"}, "law = \"brittle\"", "strengths");
        return c;
    }

    void read_minerals() {
        MineralSpec& minerals = rock_.minerals;
        if (!material_.has("minerals") || minerals.phases.empty()) return;
        const JobTable table = material_.table("minerals");
        minerals.unlike = table.choice("unlike", unlike_rules);
        minerals.unlike_strength = table.number("unlike_strength");
        minerals.cluster_length_m = table.quantity("cluster_length");
        const int ways = (table.has("map") ? 1 : 0) + (table.has("list") ? 1 : 0) + (minerals.cluster_length_m > 0.0 ? 1 : 0);
        table.check({"map", "list", "cluster_length"}, [&] {
            if (ways > 1)
                table.fail(table.has("map") ? "map" : "list", "the place of the minerals is given in two ways",
                           "one of: map, list, cluster_length");
        });
        const bool sized = std::any_of(minerals.phases.begin(), minerals.phases.end(),
                                       [](const Mineral& phase) { return phase.sizes.has_value(); });
        for (const char* key : {"map", "list", "cluster_length"})
            if (sized && table.has(key) && (std::string_view(key) != "cluster_length" || minerals.cluster_length_m > 0.0))
                table.check({}, [&] {
                    table.fail(key,
                               "says which grain is of which mineral, but minerals have sizes of their own (diameter of "
                               "[[material.phase]]): then each grain is of the mineral whose size it has",
                               "one of them");
                });
        table.check({"unlike"}, [&] {
            if (minerals.unlike != UnlikeRule::given) return;
            for (int a = 0; a < std::ssize(minerals.phases); ++a)
                for (int b = a; b < std::ssize(minerals.phases); ++b)
                    if (std::none_of(minerals.pairs.begin(), minerals.pairs.end(), [&](const PhasePair& pair) {
                            return !pair.inside && std::minmax(pair.a, pair.b) == std::minmax(a, b);
                        }))
                        table.fail("unlike",
                                   fmt::format("the pair of \"{}\" and \"{}\" has no law", minerals.phases[a].name,
                                               minerals.phases[b].name),
                                   "a [[material.pair]] for each pair of minerals, and of each with itself",
                                   "unlike = \"weaker\" makes the missing ones");
        });
        if (table.has("map"))
            table.check({"map"}, [&] {
                minerals.map_file =
                    read_file(table, "map", "map", [&](const std::string& contents, const std::filesystem::path& file) {
                        minerals.map = read_phase_map(contents, file, minerals.phases);
                    });
            });
        if (table.has("list"))
            table.check({"list"}, [&] {
                minerals.list_file =
                    read_file(table, "list", "list", [&](const std::string& contents, const std::filesystem::path& file) {
                        minerals.list = read_phase_list(contents, file, minerals.phases);
                    });
            });
    }

    // Has the file of a key read, and notes what is in it for the identity of runs. @return its absolute path
    template <class Read>
    std::string read_file(const JobTable& table, std::string_view key, const char* what, Read read) {
        const std::filesystem::path file = file_of(table, key);
        const std::string contents = contents_of(table, key, file, what);
        read(contents, file);
        rock_.files += fmt::format("{:016x}\n", XXH3_64bits(contents.data(), contents.size()));
        return std::filesystem::absolute(file).string();
    }

    Distribution read_distribution(const JobTable& table) const {
        Distribution d;
        d.kind = table.choice("distribution", distribution_kinds);
        if (table.sound({"distribution"})) table.suit("distribution", name(d.kind), table.level_of("distribution"));
        const bool modulus = table.has("modulus"), variation = table.has("variation");
        table.check({"modulus", "variation"}, [&] {
            if (modulus && variation && table.level_of("modulus") == table.level_of("variation"))
                table.fail("variation", "given beside modulus, from which it follows", "one of the two");
            if (!variation && !(modulus && d.kind == DistributionKind::weibull))
                table.fail(
                    "variation", d.kind == DistributionKind::weibull ? "missing key: modulus" : "missing key: variation",
                    d.kind == DistributionKind::weibull ? "the Weibull modulus, or variation" : "the coefficient of variation");
        });
        const bool by_variation = variation && (!modulus || table.level_of("variation") < table.level_of("modulus"));
        if (by_variation) {
            d.variation = table.fraction("variation");
            if (d.kind == DistributionKind::weibull && d.variation > 0.0) d.weibull_modulus = weibull_modulus_of(d.variation);
        } else if (modulus) {
            d.weibull_modulus = table.number("modulus");
        }
        d.lowest = table.number("lowest", d.kind == DistributionKind::normal ? 0.05 : 0.0);
        if (table.has("highest")) d.highest = table.number("highest");
        d.correlation_length_m = table.quantity("correlation_length");
        return d;
    }

    void read_scatter() {
        if (!material_.has("scatter")) return;
        const JobTable table = material_.table("scatter");
        rock_.scatter.energy_power = table.number("energy_power");
        for (const Scattered quantity : scattered_quantities)
            if (table.has(name(quantity))) rock_.scatter[quantity] = read_distribution(table.table(name(quantity)));
        if (model_known_ && model_.kind != GrainKind::flexible && table.has("E"))
            table.check({}, [&] {
                table.fail("E", fmt::format("kind = \"{}\": these grains have no Young's modulus", name(model_.kind)),
                           "stiffness, which scatters Kn and the shear stiffness of contacts");
            });
    }

    void read_initial_cracks() {
        if (!material_.has("initial_cracks")) return;
        const JobTable table = material_.table("initial_cracks");
        InitialCracks& cracks = rock_.initial_cracks;
        cracks.broken = table.fraction("broken");
        cracks.opening_m = table.quantity("opening");
        cracks.weakened = table.fraction("weakened");
        cracks.weakened_strength = table.number("weakened_strength", 1.0);
        table.check({"broken", "weakened", "weakened_strength"}, [&] {
            if (cracks.broken + cracks.weakened > 1.0)
                table.fail("weakened", "broken and weakened contacts are more than all", "together at most 100 %");
            if (cracks.weakened > 0.0 && !table.has("weakened_strength"))
                table.fail("weakened_strength", "missing key: weakened_strength", table.allowed("weakened_strength"));
        });
    }

    void read_joints() {
        if (!material_.has("joint")) return;
        for (const JobTable& table : material_.tables("joint", "a joint")) {
            JointSpec joint;
            joint.name = read_name(table, fmt::format("joint-{}", rock_.joints.size() + 1));
            table.check({"name"}, [&] {
                for (const JointSpec& other : rock_.joints)
                    if (other.name == joint.name)
                        table.fail("name", fmt::format("\"{}\" is given twice", joint.name), "each joint a name of its own");
            });
            const int ways = (table.has("trace") ? 1 : 0) + (table.has("cut") ? 1 : 0) + (table.has("file") ? 1 : 0) +
                             (table.has("set") ? 1 : 0);
            table.check({"trace", "cut", "file", "set"}, [&] {
                if (ways != 1)
                    table.fail("trace", ways == 0 ? "the joint has no place" : "the joint has several places",
                               "one of: trace, cut, file, set");
            });
            if (table.has("trace")) {
                std::vector<Vec2> line;
                table.pairs("trace", "a point", "points such as [[\"0 mm\", \"20 mm\"], [\"80 mm\", \"60 mm\"]]",
                            [&](const toml::node& x, const toml::node& y) {
                                line.push_back({table.first_of(x, "trace"), table.second_of(y, "trace")});
                                if (line.size() > 1 && line[line.size() - 2] == line.back())
                                    table.fail_at(x, "trace", "a point that is given twice in a row", "different points");
                            });
                table.check({"trace"}, [&] {
                    if (line.size() < 2) table.fail("trace", "a trace of one point", "two points or more");
                });
                joint.lines_m.push_back(std::move(line));
            }
            if (table.has("cut")) joint.cut = table.text("cut");
            if (table.has("file"))
                table.check({"file", "unit", "layer"}, [&] {
                    joint.unit = table.text("unit", "");
                    joint.layer = table.text("layer", "");
                    joint.file =
                        read_file(table, "file", "trace", [&](const std::string& contents, const std::filesystem::path& file) {
                            TraceFile read = read_traces(contents, file, joint.unit, joint.layer);
                            joint.lines_m = std::move(read.lines_m);
                            rock_.remarks.insert(rock_.remarks.end(), read.remarks.begin(), read.remarks.end());
                        });
                });
            else
                table.refuse({"unit", "layer"}, "a joint without a file");
            if (table.has("set")) joint.set = read_set(table.table("set"));
            joint.contact = contact_;
            ContactMaterial& c = joint.contact;
            c.Kn_Pa_m = table.has("Kn") ? table.quantity("Kn") : contact_.Kn_Pa_m;
            c.eta = table.has("eta") ? table.number("eta") : contact_.eta;
            c.mu = read_friction(table).value_or(contact_.mu);
            c.sigma_nt_Pa = table.quantity("sigma_nt", 0.0);
            c.tau_Pa = table.quantity("tau", 0.0);
            c.Gfn_J_m2 = table.quantity("Gfn", 0.0);
            c.Gfs_J_m2 = table.quantity("Gfs", 0.0);
            joint.opening_m = table.quantity("opening");
            read_dilation(table, joint);
            table.check({"opening", "sigma_nt", "tau"}, [&] {
                if (joint.opening_m > 0.0 && c.sigma_nt_Pa + c.tau_Pa > 0.0)
                    table.fail("opening", "a joint with strength cannot be open", "opening without sigma_nt and tau");
            });
            rock_.joints.push_back(std::move(joint));
        }
    }

    static void read_dilation(const JobTable& table, JointSpec& joint) {
        joint.dilation = std::tan(table.quantity("dilation"));
        joint.dilation_slip_m = table.quantity("dilation_slip", 0.0);
        table.check({"dilation", "dilation_slip", "mu", "phi"}, [&] {
            if (joint.dilation > 0.0 && !table.has("dilation_slip"))
                table.fail("dilation_slip", "missing key: dilation_slip",
                           "the slip after which the joint dilates no more, such as \"2 mm\"");
            if (joint.dilation == 0.0 && table.has("dilation_slip"))
                table.fail("dilation_slip", "of a joint that does not dilate", "beside dilation");
            if (joint.dilation > joint.contact.mu * (1.0 + 1e-12))  // it would give out more than the shear force puts in
                table.fail("dilation",
                           fmt::format("{} is more than the friction angle, {:.4g} degrees", shown(*table.find("dilation")),
                                       std::atan(joint.contact.mu) * 180.0 / std::numbers::pi),
                           "at most the friction angle, of which it is a part",
                           "phi is the whole angle: that of a smooth surface, and what climbing takes");
        });
    }

    static JointSet read_set(const JobTable& table) {
        table.require({"dip", "spacing"});
        JointSet set;
        set.dip_rad = table.quantity("dip");
        set.dip_deviation_rad = table.quantity("dip_deviation");
        set.spacing_m = table.quantity("spacing");
        set.spacing_variation = table.fraction("spacing_variation");
        set.length_m = table.quantity("length", 0.0);
        set.length_variation = table.fraction("length_variation");
        if (table.has("persistence")) set.persistence = table.fraction("persistence");
        table.check({"length", "persistence"}, [&] {
            if (table.has("length") != table.has("persistence"))
                table.fail(table.has("length") ? "persistence" : "length",
                           table.has("length") ? "missing key: persistence" : "missing key: length",
                           "length and persistence together, or neither: through the whole specimen");
        });
        return set;
    }

    const JobTable& material_;
    const ModelSpec& model_;
    bool model_known_;
    int decided_at_;
    const GrainMaterial& grain_;
    const ContactMaterial& contact_;
    Heterogeneity rock_;
};

}  // namespace

Heterogeneity read_rock(const JobTable& material, const ModelSpec& model, bool model_known, int model_decided_at,
                        const GrainMaterial& grain, const ContactMaterial& contact) {
    return RockReader(material, model, model_known, model_decided_at, grain, contact).read();
}

}  // namespace feldspar
