// Jobs to start from with first contact parameters for a rock of which the laboratory's numbers are known: `feldspar new KIND
// --UCS ...`.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/lab/scaling_rules.hpp"

namespace feldspar {

/// A number that a user may give of his rock.
struct GivenName {
    std::string_view option;  ///< "UCS": as the command line calls it, behind two hyphens
    std::string_view key;     ///< "UCS": of [laboratory]; empty: none
    std::string_view meaning;
};

/// In the order in which users are told.
std::span<const GivenName> given_names();

/// What the user says of his rock.
struct GivenRock {
    std::string rock;                           ///< of literature_rocks(), or a kind of rock; may be empty
    std::map<std::string, std::string> values;  ///< by GivenName::option, as written: "120 MPa"

    bool any() const { return !rock.empty() || !values.empty(); }
};

/// The same read: targets of the scaling rules, and the rows of [laboratory] in the user's units.
struct ReadRock {
    RockTargets targets;
    double grain_m = 3e-3;                                        ///< mean diameter of the model's grains
    std::vector<std::pair<std::string, std::string>> laboratory;  ///< key and value as TOML: {"UCS", "\"120 MPa\""}
    std::vector<std::string> assumed;                             ///< what comes from the named rock, in sentences
    std::vector<std::string> warnings;
    std::string source;  ///< where the named rock's numbers come from; empty without one
};

/// @throws InputError (key "--UCS") for a bad unit, a value that no rock has, UCS not above a tensile strength, or no strength at
/// all
ReadRock read_rock_numbers(const GivenRock& given);

struct FirstJob {
    std::string text;                   ///< a job, which read_job() accepts
    std::vector<std::string> warnings;  ///< what the rock has and the model cannot show
    FirstParameters first;
};

/// The commented job of this kind (job_template()) with first parameters for this rock, its numbers under [laboratory], and what
/// is expected of them in comments.
/// @throws InputError as read_rock_numbers(), and for an unknown kind
FirstJob first_job(std::string_view kind, const GivenRock& given);

/// `text` with the keys of a table that are given set to these values, keeping comments; of the template's keys in `optional`
/// those that are not given are commented out.
std::string with_values(const std::string& text, std::string_view table,
                        const std::vector<std::pair<std::string, std::string>>& values,
                        std::span<const std::string_view> optional = {});

}  // namespace feldspar
