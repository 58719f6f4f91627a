// Materials of the literature by name, so that a comparison need not copy tables: `elastic_preset` and `strength_preset`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "feldspar/job/toml_reader.hpp"
#include "feldspar/model/spec.hpp"

namespace feldspar {

/// A set of material keys with a name.
struct Preset {
    std::string_view name;
    std::string_view source;        ///< the table it comes from
    std::optional<GrainKind> kind;  ///< the grains that it was fitted for, where that matters
    std::string_view keys;          ///< TOML: tables `grain` and `contact`, as under [material]
};

/// Stiffnesses: Kn and eta, with E and nu of flexible grains.
std::span<const Preset> elastic_presets();

/// Laws and strengths: law, sigma_nt, tau, mu, Gfn, Gfs.
std::span<const Preset> strength_presets();

/// The keys of a preset, parsed once; they live as long as the program.
const toml::table& preset_table(const Preset& preset);

/// All presets with their values and sources, to be read: what `feldspar new --presets` prints.
std::string preset_overview();

}  // namespace feldspar
