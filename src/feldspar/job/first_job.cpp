#include "feldspar/job/first_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "feldspar/base/error.hpp"
#include "feldspar/base/plain_text.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/rocks.hpp"

namespace feldspar {
namespace {

constexpr std::size_t kCommentColumn = 36;
constexpr double kDegrees = std::numbers::pi / 180.0;

constexpr auto names = std::to_array<GivenName>({
    {"E", "E", "Young's modulus, such as \"30 GPa\""},
    {"nu", "nu", "Poisson's ratio"},
    {"UCS", "UCS", "uniaxial compressive strength, such as \"120 MPa\""},
    {"BTS", "BTS", "Brazilian tensile strength"},
    {"DTS", "DTS", "direct tensile strength; in place of BTS if that is not known"},
    {"cohesion", "cohesion", "cohesion of the Mohr-Coulomb line"},
    {"friction-angle", "friction_angle", "friction angle of the Mohr-Coulomb line, such as \"50 deg\""},
    {"sigma-ci", "sigma_ci", "crack initiation stress; shown beside the results"},
    {"grain-size", "", "mean diameter of the model's grains; 3 mm unless given"},
});

std::string option_of(std::string_view name) { return "--" + std::string(name); }

// "120MPa" as "120 MPa".
std::string tidy(std::string_view text) {
    double value = 0.0;
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::size_t at = static_cast<std::size_t>(end - text.data());
    if (error != std::errc{} || at >= text.size() || text[at] == ' ' || text[at] == '%') return std::string(text);
    return std::string(text.substr(0, at)) + " " + std::string(text.substr(at));
}

double pure_number(std::string_view text, const std::string& option) {
    const std::optional<double> value = finite_number(text);
    if (!value) throw InputError({.key = option}, "'" + std::string(text) + "' is no number", "a plain number, such as 0.25");
    return *value;
}

// A quantity of the command line, whose errors name the option.
double read_quantity(std::string_view name, const std::string& text, Dimension dimension) {
    double value = 0.0;
    try {
        value = parse_quantity(text, dimension);
    } catch (const InputError& error) {
        throw InputError({.key = option_of(name)}, error.problem(), error.allowed(), error.suggestion());
    }
    return value;
}

void refuse(std::string_view name, const std::string& text, const std::string& why, const std::string& allowed) {
    throw InputError({.key = option_of(name)}, "'" + text + "' " + why, allowed);
}

double positive_quantity(std::string_view name, const std::string& text, Dimension dimension, double low, double high,
                         const char* allowed) {
    const double value = read_quantity(name, text, dimension);
    if (!(value > 0.0)) refuse(name, text, "is not above zero", allowed);
    if (value < low || value > high) refuse(name, text, "is nothing that rocks have", allowed);
    return value;
}

std::string four(double value, std::string_view unit) {
    return fmt::format("\"{:.4g}{}{}\"", value, unit.empty() ? "" : " ", unit);
}

// A comment of lines of about 140 characters.
std::string comment(const std::string& text) {
    std::istringstream words(text);
    std::string lines = "#", word;
    std::size_t width = 1;
    while (words >> word) {
        if (width + word.size() > 140) lines += "\n#", width = 1;
        lines += " " + word;
        width += word.size() + 1;
    }
    return lines + "\n";
}

std::string numbers_in_words(const RockNumbers& n) {
    return fmt::format("E {:.3g} GPa, nu {:.2g}, UCS {:.3g} MPa, DTS {:.3g} MPa, BTS {:.3g} MPa, friction angle {:.2g} deg",
                       1e-9 * n.E_Pa, n.nu, 1e-6 * n.UCS_Pa, 1e-6 * n.DTS_Pa, 1e-6 * n.BTS_Pa, n.friction_angle_deg);
}

// What the model cannot show, and what then helps.
std::string out_of_reach(const ReadRock& rock, const FirstParameters& first) {
    const char* ratio = first.of_DTS ? "UCS/DTS" : "UCS/BTS";
    std::string text = fmt::format(
        "{} of {:.3g} is out of reach of an even rock of such contacts: the rules reach {:.3g} to {:.3g}. These parameters meet "
        "the UCS, and leave a {} of about {:.3g} MPa.",
        ratio, first.wanted_ratio, first.lowest_ratio, first.highest_ratio, first.of_DTS ? "DTS" : "BTS",
        1e-6 * (first.of_DTS ? first.expected.DTS_Pa : first.expected.BTS_Pa));
    if (first.wanted_ratio < first.lowest_ratio)
        return text + " A lower ratio wants tougher contacts (a larger Gfn), which a calibration may try.";
    const auto scatter = scatter_for(rock.targets, rock.grain_m);
    if (!scatter)
        return text +
               " Scatter of the strengths brings it nearer, and so do contacts that are broken before the test "
               "([material.scatter], [material.initial_cracks]; docs/theory/heterogeneity.md).";
    const FirstParameters uneven = first_parameters(rock.targets, rock.grain_m, *scatter);
    const ContactMaterial& c = uneven.contact;
    return text + fmt::format(
                      " Strengths that scatter reach it (docs/theory/heterogeneity.md): by the rules [material.scatter] strength "
                      "= {{ modulus = {:.2g}, lowest = 0.1 }} with sigma_nt = \"{:.3g} MPa\", tau = \"{:.4g} MPa\", "
                      "mu = {:.2g}, Gfn = \"{:.3g} N/m\", Gfs = \"{:.4g} N/m\".",
                      1.0 / *scatter, 1e-6 * c.sigma_nt_Pa, 1e-6 * c.tau_Pa, c.mu, c.Gfn_J_m2, c.Gfs_J_m2);
}

void take_rock(const LiteratureRock& rock, const GivenRock& given, ReadRock& read) {
    RockTargets& t = read.targets;
    const auto known = [](double value) { return std::isfinite(value); };
    if (given.values.empty() || (given.values.size() == 1 && given.values.contains("grain-size"))) {  // all that is known of it
        read.source = rock.source;
        const auto take = [&](std::string_view key, double value, double unit, std::string_view unit_name,
                              std::optional<double>& target) {
            if (!known(value)) return;
            target = value * unit;
            read.laboratory.emplace_back(
                key, unit_name.empty() ? fmt::format("{:g}", value) : fmt::format("\"{:g} {}\"", value, unit_name));
        };
        take("E", rock.E_GPa, 1e9, "GPa", t.E_Pa);
        take("nu", rock.nu, 1.0, "", t.nu);
        take("UCS", rock.UCS_MPa, 1e6, "MPa", t.UCS_Pa);
        take("BTS", rock.BTS_MPa, 1e6, "MPa", t.BTS_Pa);
        take("cohesion", rock.cohesion_MPa, 1e6, "MPa", t.cohesion_Pa);
        take("friction_angle", rock.friction_angle_deg, 1.0, "deg", t.friction_angle_deg);
        return;
    }
    const auto assume = [&](std::optional<double>& target, double value, const std::string& words) {
        if (target || !known(value)) return;
        target = value;
        read.assumed.push_back(fmt::format("{} ({})", words, rock.name));
    };
    assume(t.E_Pa, 1e9 * rock.E_GPa, fmt::format("E = {:g} GPa", rock.E_GPa));
    assume(t.nu, rock.nu, fmt::format("Poisson's ratio of {:g}", rock.nu));
    if (!t.cohesion_Pa)
        assume(t.friction_angle_deg, rock.friction_angle_deg, fmt::format("friction angle of {:g} deg", rock.friction_angle_deg));
    const double ratio = rock.UCS_MPa / rock.BTS_MPa;
    if (t.UCS_Pa && !t.DTS_Pa) assume(t.BTS_Pa, *t.UCS_Pa / ratio, fmt::format("UCS over BTS of {:.3g}", ratio));
    if (!t.UCS_Pa && t.BTS_Pa && !t.cohesion_Pa)
        assume(t.UCS_Pa, *t.BTS_Pa * ratio, fmt::format("UCS over BTS of {:.3g}", ratio));
}

// The head of the template tells whose numbers it has.
std::string with_head(std::string text, const std::string& head) {
    const std::size_t from = text.find("# The numbers are those of the Augig granite"), end = text.find("\n\n", from);
    if (from == std::string::npos) return head + text;
    return text.replace(from, end - from,
                        head + "# A line that begins with '#' and a key shows a key that may be left out, with its default.");
}

}  // namespace

std::span<const GivenName> given_names() { return names; }

ReadRock read_rock_numbers(const GivenRock& given) {
    ReadRock read;
    RockTargets& t = read.targets;
    const auto with = [&](std::string_view name, const std::function<void(const std::string&)>& take) {
        const auto found = given.values.find(std::string(name));
        if (found == given.values.end()) return;
        take(found->second);
    };
    const auto stress_of = [&](std::string_view name, std::optional<double>& target, double low, double high,
                               const char* allowed) {
        with(name,
             [&](const std::string& text) { target = positive_quantity(name, text, Dimension::stress, low, high, allowed); });
    };
    stress_of("E", t.E_Pa, 1e7, 1e12, "a modulus from 0.01 to 1000 GPa, such as \"30 GPa\"");
    stress_of("UCS", t.UCS_Pa, 1e4, 2e9, "a strength from 0.01 to 2000 MPa, such as \"120 MPa\"");
    stress_of("BTS", t.BTS_Pa, 1e3, 2e8, "a strength from 0.001 to 200 MPa, such as \"9 MPa\"");
    stress_of("DTS", t.DTS_Pa, 1e3, 2e8, "a strength from 0.001 to 200 MPa, such as \"7 MPa\"");
    stress_of("cohesion", t.cohesion_Pa, 1e3, 1e9, "a stress from 0.001 to 1000 MPa, such as \"20 MPa\"");
    with("nu", [&](const std::string& text) {
        t.nu = pure_number(text, "--nu");
        if (!(*t.nu >= 0.0 && *t.nu < 0.5)) refuse("nu", text, "is no Poisson's ratio of a rock", "a number from 0 to below 0.5");
    });
    with("friction-angle", [&](const std::string& text) {
        t.friction_angle_deg = read_quantity("friction-angle", text, Dimension::angle) / kDegrees;
        if (!(*t.friction_angle_deg > 0.0 && *t.friction_angle_deg < 90.0))
            refuse("friction-angle", text, "is no friction angle", "an angle above 0 and below 90 deg, such as \"50 deg\"");
    });
    std::optional<double> sigma_ci;
    stress_of("sigma-ci", sigma_ci, 1e3, 2e9, "a stress from 0.001 to 2000 MPa, such as \"55 MPa\"");
    with("grain-size", [&](const std::string& text) {
        read.grain_m =
            positive_quantity("grain-size", text, Dimension::length, 1e-5, 16e-3,
                              "a length from 0.01 to 16 mm: the specimen is 80 mm wide and wants five grains across at least");
    });
    for (const auto& [key, text] : given.values)
        if (std::none_of(names.begin(), names.end(), [&, &option = key](const GivenName& name) { return name.option == option; }))
            throw InputError({.key = option_of(key)}, "is no number of a rock");

    for (const GivenName& name : names) {
        const auto found = given.values.find(std::string(name.option));
        if (name.key.empty() || found == given.values.end()) continue;
        read.laboratory.emplace_back(name.key, name.option == "nu" ? found->second : fmt::format("\"{}\"", tidy(found->second)));
    }
    if (!given.rock.empty()) take_rock(literature_rock(given.rock), given, read);

    for (const auto& [name, tension] : {std::pair("BTS", t.BTS_Pa), std::pair("DTS", t.DTS_Pa)})
        if (tension && t.UCS_Pa && *tension >= *t.UCS_Pa)
            throw InputError(
                {.key = option_of("UCS")},
                fmt::format("a UCS of {:.4g} MPa is not above the {} of {:.4g} MPa", 1e-6 * *t.UCS_Pa, name, 1e-6 * *tension),
                "rocks are 4 to 60 times as strong in compression as in tension", "are the two exchanged?");
    if (sigma_ci && t.UCS_Pa && *sigma_ci > *t.UCS_Pa)
        throw InputError({.key = "--sigma-ci"}, "is above the UCS", "a share of the UCS: most rocks have 0.3 to 0.6");
    if (!t.UCS_Pa && !t.BTS_Pa && !t.DTS_Pa && !(t.cohesion_Pa && t.friction_angle_deg))
        throw InputError({.key = "--UCS"}, "no strength is given",
                         "--UCS, --BTS or --DTS, or both --cohesion and --friction-angle; or --rock with a rock of the list "
                         "(feldspar new --presets)");
    if (t.UCS_Pa && t.cohesion_Pa && t.friction_angle_deg) {
        const double line = 2.0 * *t.cohesion_Pa * std::tan((45.0 + 0.5 * *t.friction_angle_deg) * kDegrees);
        if (std::abs(line / *t.UCS_Pa - 1.0) > 0.25)
            read.warnings.push_back(
                fmt::format("cohesion and friction angle mean a UCS of {:.3g} MPa (2 c tan(45 deg + phi / 2)), and {:.3g} MPa is "
                            "given: no rock shows both; the UCS is met",
                            1e-6 * line, 1e-6 * *t.UCS_Pa));
    }
    if (sigma_ci && t.UCS_Pa && *sigma_ci < 0.38 * *t.UCS_Pa)
        read.warnings.push_back(
            fmt::format("crack initiation at {:.2g} of the UCS: even rocks of this model begin to crack later; strengths that "
                        "scatter bring it down (docs/theory/heterogeneity.md)",
                        *sigma_ci / *t.UCS_Pa));
    if (read.grain_m > 8e-3)
        read.warnings.push_back(
            "grains of more than 8 mm: the specimen of 80 mm has less than ten across, and strengths scatter from packing to "
            "packing");
    return read;
}

std::string with_values(const std::string& text, std::string_view table,
                        const std::vector<std::pair<std::string, std::string>>& values,
                        std::span<const std::string_view> optional) {
    std::istringstream lines(text);
    std::string written;
    bool inside = false;
    std::vector<std::string> seen;
    const auto add_missing = [&] {  // those that the template does not show
        for (const auto& [key, value] : values)
            if (std::find(seen.begin(), seen.end(), key) == seen.end()) written += fmt::format("{} = {}\n", key, value);
    };
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) inside = line.starts_with(fmt::format("[{}]", table));
        const std::string bare = line.starts_with("# ") ? line.substr(2) : line;
        const std::size_t equals = bare.find(" = ");
        const std::string key = inside && equals != std::string::npos ? bare.substr(0, equals) : "";
        const auto value = std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.first == key; });
        if (!key.empty() && value != values.end() && std::find(seen.begin(), seen.end(), key) == seen.end()) {
            seen.push_back(key);
            const std::size_t remark = bare.find("   #") == std::string::npos ? bare.rfind(" # ") : bare.find("   #");
            std::string now = key + " = " + value->second;
            if (remark != std::string::npos) {
                now.resize(std::max(now.size() + 1, kCommentColumn), ' ');
                now += bare.substr(bare.find('#', remark));
            }
            line = now;
        } else if (inside && line == bare && std::find(optional.begin(), optional.end(), key) != optional.end()) {
            line.insert(0, "# ");
        }
        written.append(line).append("\n");
    }
    if (inside) add_missing();
    return written;
}

FirstJob first_job(std::string_view kind, const GivenRock& given) {
    std::string text = job_template(kind);
    const ReadRock rock = read_rock_numbers(given);
    FirstJob job;
    job.first = first_parameters(rock.targets, rock.grain_m);
    job.warnings = rock.warnings;
    const FirstParameters& first = job.first;

    std::string head = comment(
        "The contact parameters are first ones, by scaling rules that were measured on small specimens "
        "(docs/validation/first-parameters.md); they are no calibration. The rules expect of them " +
        numbers_in_words(first.expected) +
        fmt::format("; their own errors are {:.0f} % of UCS and {:.0f} % of BTS. Better ones: feldspar new calibration, with the "
                    "same options.",
                    100.0 * rule_errors.UCS, 100.0 * rule_errors.BTS));
    if (!rock.source.empty()) head += comment("Laboratory: " + rock.source + ".");
    std::vector<std::string> assumed = rock.assumed;
    assumed.insert(assumed.end(), first.assumed.begin(), first.assumed.end());
    if (!assumed.empty()) head += comment("Not given and assumed: " + fmt::format("{}", fmt::join(assumed, "; ")) + ".");
    if (!first.ratio_reached()) {
        const std::string why = out_of_reach(rock, first);
        head += comment("NOTE: " + why);
        job.warnings.push_back(why);
    }
    if (!first.friction_reached) {
        const std::string why = fmt::format(
            "a friction angle of {:.3g} deg is out of reach: these contacts have about {:.3g} deg",
            rock.targets.friction_angle_deg.value_or(first.expected.friction_angle_deg), first.expected.friction_angle_deg);
        head += comment("NOTE: " + why + ".");
        job.warnings.push_back(why);
    }
    constexpr double kLeastStrain = 8e-5;  // sigma_nt / E, the end of the experiment
    if (const double strain = first.contact.sigma_nt_Pa / first.grain.E_Pa; strain < kLeastStrain) {
        const std::string why = fmt::format(
            "sigma_nt / E of {:.1e} is below what the rules were measured at ({:.0e} to 5e-04): so stiff and weak a rock came "
            "out 10 to 90 % too strong in compression, with tests of grade C",
            strain, kLeastStrain);
        head += comment("NOTE: " + why + ".");
        job.warnings.push_back(why);
    }
    for (const std::string& warning : rock.warnings) head += comment("NOTE: " + warning + ".");
    text = with_head(std::move(text), head);

    const GrainMaterial& grain = first.grain;
    const ContactMaterial& c = first.contact;
    const double d_mm = 1e3 * rock.grain_m;
    if (given.values.contains("grain-size"))
        text = with_values(text, "specimen.grains",
                           {{"diameter", fmt::format("{{ distribution = \"uniform\", minimum = {}, maximum = {} }}",
                                                     four(d_mm * 2.0 / 3.0, "mm"), four(d_mm * 4.0 / 3.0, "mm"))}});
    text = with_values(text, "material.grain", {{"E", four(1e-9 * grain.E_Pa, "GPa")}, {"nu", fmt::format("{:.3g}", grain.nu)}});
    text = with_values(text, "material.contact",
                       {{"Kn", four(1e-9 * c.Kn_Pa_m, "GPa/m")},
                        {"eta", fmt::format("{:.3g}", c.eta)},
                        {"sigma_nt", four(1e-6 * c.sigma_nt_Pa, "MPa")},
                        {"tau", four(1e-6 * c.tau_Pa, "MPa")},
                        {"mu", fmt::format("{:.3g}", c.mu)},
                        {"Gfn", four(c.Gfn_J_m2, "N/m")},
                        {"Gfs", four(c.Gfs_J_m2, "N/m")}});
    constexpr std::array<std::string_view, 8> shown{
        "E", "nu", "UCS", "DTS", "BTS", "cohesion", "friction_angle", "hoek_brown_mi"};
    text = with_values(text, "laboratory", rock.laboratory, shown);
    job.text = std::move(text);
    return job;
}

}  // namespace feldspar
