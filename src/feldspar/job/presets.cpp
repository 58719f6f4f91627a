#include "feldspar/job/presets.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "feldspar/job/rocks.hpp"

namespace feldspar {
namespace {

// N. Monteiro Azevedo, M. L. B. Farinha, S. Oliveira: A Flexible Particle Model for Rock Fracture, Geotechnics 2022, 2, 523-548.
constexpr auto elastic = std::to_array<Preset>({
    {"augig-rigid", "Table 1", GrainKind::rigid, "contact = { Kn = \"1.08e4 GPa/m\", eta = 0.28 }"},
    {"augig-flexible", "Table 1, section 4.2", GrainKind::flexible,
     "grain = { E = \"25.8 GPa\", nu = 0.23 }\ncontact = { Kn = \"18.00e4 GPa/m\", eta = 0.28 }"},
    {"augig-flexible-51.6", "Table 1, section 4.2", GrainKind::flexible,
     "grain = { E = \"51.6 GPa\", nu = 0.23 }\ncontact = { Kn = \"2.06e4 GPa/m\", eta = 0.28 }"},
    {"augig-inner-particles", "Table 1", GrainKind::inner_particles, "contact = { Kn = \"4.90e4 GPa/m\", eta = 0.30 }"},
    // The others: docs/validation/first-parameters.md; their laboratory's numbers and sources are in rocks.cpp.
    {"lac-du-bonnet-granite", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"73.65 GPa\", nu = 0.26 }\ncontact = { Kn = \"4.91e5 GPa/m\", eta = 0.28 }"},
    {"nevada-granite", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"78.78 GPa\", nu = 0.217 }\ncontact = { Kn = \"5.252e5 GPa/m\", eta = 0.28 }"},
    {"cedar-city-tonalite", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"20.5 GPa\", nu = 0.164 }\ncontact = { Kn = \"1.366e5 GPa/m\", eta = 0.28 }"},
    {"basalt", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"83.25 GPa\", nu = 0.249 }\ncontact = { Kn = \"5.55e5 GPa/m\", eta = 0.28 }"},
    {"nevada-basalt", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"37.24 GPa\", nu = 0.324 }\ncontact = { Kn = \"2.483e5 GPa/m\", eta = 0.28 }"},
    {"transjurane-sandstone", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"13.34 GPa\", nu = 0.303 }\ncontact = { Kn = \"8.894e4 GPa/m\", eta = 0.28 }"},
    {"oneota-dolomite", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"46.85 GPa\", nu = 0.345 }\ncontact = { Kn = \"3.123e5 GPa/m\", eta = 0.28 }"},
    {"tavernalle-limestone", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"59.55 GPa\", nu = 0.303 }\ncontact = { Kn = \"3.97e5 GPa/m\", eta = 0.28 }"},
    {"cherokee-marble", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"59.56 GPa\", nu = 0.249 }\ncontact = { Kn = \"3.971e5 GPa/m\", eta = 0.28 }"},
    {"micaceous-shale", "first guess by scaling rules", GrainKind::flexible,
     "grain = { E = \"11.85 GPa\", nu = 0.292 }\ncontact = { Kn = \"7.898e4 GPa/m\", eta = 0.28 }"},
});

constexpr auto strength = std::to_array<Preset>({
    {"augig-table2-brittle", "Table 2, fitted with rigid grains", std::nullopt,
     "contact = { law = \"brittle\", sigma_nt = \"13.70 MPa\", tau = \"48.80 MPa\", mu = 0.40 }"},
    {"augig-table2-bilinear", "Table 2, fitted with rigid grains", std::nullopt,
     "contact = { law = \"bilinear\", sigma_nt = \"11.5 MPa\", tau = \"33.25 MPa\", mu = 0.5, Gfn = \"66.1 N/m\", Gfs = \"2078.6 "
     "N/m\" }"},
    {"augig-table7", "Table 7, fitted with flexible grains", std::nullopt,
     "contact = { law = \"bilinear\", sigma_nt = \"8.5 MPa\", tau = \"29.75 MPa\", mu = 0.40, Gfn = \"20.0 N/m\", Gfs = \"800.0 "
     "N/m\" }"},
    {"lac-du-bonnet-granite", "first guess by scaling rules, UCS alone: UCS/BTS is out of reach", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"9.233 MPa\", tau = \"55.4 MPa\", mu = 0.64, Gfn = \"0.8681 N/m\", Gfs = "
     "\"173.6 N/m\" }"},
    {"nevada-granite", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"8.325 MPa\", tau = \"30.36 MPa\", mu = 0.514, Gfn = \"2.728 N/m\", Gfs = "
     "\"245.7 N/m\" }"},
    {"cedar-city-tonalite", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"4.521 MPa\", tau = \"20.85 MPa\", mu = 0.651, Gfn = \"1.583 N/m\", Gfs = "
     "\"316.7 N/m\" }"},
    {"basalt", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"10.75 MPa\", tau = \"56.58 MPa\", mu = 0.744, Gfn = \"1.513 N/m\", Gfs = "
     "\"302.6 N/m\" }"},
    {"nevada-basalt", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"9.437 MPa\", tau = \"32.51 MPa\", mu = 0.485, Gfn = \"8.724 N/m\", Gfs = "
     "\"595.8 N/m\" }"},
    {"transjurane-sandstone", "first guess by scaling rules, UCS alone: UCS/BTS is out of reach", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"2.527 MPa\", tau = \"15.16 MPa\", mu = 0.391, Gfn = \"0.359 N/m\", Gfs = "
     "\"71.79 N/m\" }"},
    {"oneota-dolomite", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"3.356 MPa\", tau = \"18.71 MPa\", mu = 0.789, Gfn = \"0.2223 N/m\", Gfs = "
     "\"44.46 N/m\" }"},
    {"tavernalle-limestone", "first guess by scaling rules", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"3.559 MPa\", tau = \"21.35 MPa\", mu = 0.85, Gfn = \"0.1595 N/m\", Gfs = "
     "\"31.9 N/m\" }"},
    {"cherokee-marble", "first guess by scaling rules, UCS alone: UCS/BTS is out of reach", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"2.432 MPa\", tau = \"14.59 MPa\", mu = 0.85, Gfn = \"0.07447 N/m\", Gfs = "
     "\"14.89 N/m\" }"},
    {"micaceous-shale", "first guess by scaling rules, UCS alone: UCS/BTS is out of reach", GrainKind::flexible,
     "contact = { law = \"bilinear\", sigma_nt = \"2.734 MPa\", tau = \"16.4 MPa\", mu = 0.85, Gfn = \"0.4731 N/m\", Gfs = "
     "\"94.61 N/m\" }"},
});

std::string overview_of(std::string_view key, std::span<const Preset> presets) {
    std::string text;
    for (const Preset& preset : presets) {
        text += std::string(key) + " = \"" + std::string(preset.name) + "\"   # " + std::string(preset.source);
        if (preset.kind) text += std::string("; for kind = \"") + name(*preset.kind) + "\"";
        text += "\n";
        for (std::size_t at = 0; at < preset.keys.size();) {
            const std::size_t end = std::min(preset.keys.find('\n', at), preset.keys.size());
            text += "#   " + std::string(preset.keys.substr(at, end - at)) + "\n";
            at = end + 1;
        }
    }
    return text;
}

// What `feldspar new KIND --rock NAME` begins from.
std::string overview_of_rocks() {
    std::string text =
        "# Rocks of the literature, for feldspar new KIND --rock NAME: a job with first contact parameters by scaling rules "
        "(docs/validation/first-parameters.md).\n\n";
    for (const LiteratureRock& rock : literature_rocks()) {
        const auto add = [&](const char* name, double value, const char* unit) {
            if (std::isfinite(value)) text += fmt::format(" {} {:g}{}", name, value, unit);
        };
        text += fmt::format("# {}:", rock.name);
        add("E", rock.E_GPa, " GPa,");
        add("nu", rock.nu, ",");
        add("UCS", rock.UCS_MPa, " MPa,");
        add("BTS", rock.BTS_MPa, " MPa,");
        add("cohesion", rock.cohesion_MPa, " MPa,");
        add("friction angle", rock.friction_angle_deg, " deg,");
        text.back() = '\n';
        text += fmt::format("#   {}\n", rock.source);
    }
    return text;
}

}  // namespace

std::span<const Preset> elastic_presets() { return elastic; }
std::span<const Preset> strength_presets() { return strength; }

const toml::table& preset_table(const Preset& preset) {
    static const auto tables = [] {
        std::map<std::string_view, toml::table> parsed;
        for (const Preset& one : elastic) parsed.emplace(one.keys, parse_toml(std::string(one.keys), std::string(one.name)));
        for (const Preset& one : strength) parsed.emplace(one.keys, parse_toml(std::string(one.keys), std::string(one.name)));
        return parsed;
    }();
    return tables.at(preset.keys);  // a rock has an elastic and a strength preset of one name
}

std::string preset_overview() {
    return "# Presets of [material]: augig-... after Monteiro Azevedo, Farinha, Oliveira 2022, Geotechnics 2, 523-548; others "
           "first guesses by scaling rules.\n"
           "# A key in [material.grain] or [material.contact] goes before the same key of a preset.\n\n" +
           overview_of("elastic_preset", elastic) + "\n" + overview_of("strength_preset", strength) + "\n" + overview_of_rocks();
}

}  // namespace feldspar
