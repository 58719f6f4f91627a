#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "feldspar/calibration/calibration.hpp"
#include "feldspar/job/job_template.hpp"
#include "feldspar/job/presets.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/study/study.hpp"
#include "say.hpp"
#include "whole_text.hpp"

namespace feldspar {

namespace {

// What the model cannot show of the rock goes to the standard error, too.
std::string with_first_parameters(const std::string& kind, const GivenRock& rock) {
    const FirstJob first = first_job(kind, rock);
    for (const std::string& warning : first.warnings) say(stderr, "warning: {}\n", warning);
    return first.text;
}

std::string file_to_start_from(const std::string& kind, const GivenRock& rock) {
    if (kind == "study") {
        if (rock.any())
            throw InputError({}, "a study takes the numbers of a rock from its job",
                             "feldspar new laboratory with these options for the job, and feldspar new study");
        return study_template();
    }
    if (kind == "calibration") return rock.any() ? calibration_template(read_rock_numbers(rock)) : calibration_template();
    std::vector<std::string_view> kinds = job_template_kinds();
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end())
        return rock.any() ? with_first_parameters(kind, rock) : job_template(kind);
    kinds.insert(kinds.end(), {"study", "calibration"});
    throw InputError({}, "'" + kind + "' is nothing to start from", listed(kinds), did_you_mean(kind, kinds));
}

// What to do with it.
std::string next_step(const std::string& kind, const std::string& file) {
    if (kind == "study") return fmt::format("its job beside it as rock.toml, then feldspar study {}", file);
    if (kind == "calibration") return fmt::format("its job beside it as rock.toml, then feldspar calibrate {}", file);
    return fmt::format("feldspar check {}", file);
}

}  // namespace

ExitCode presets_command() { return print_whole(preset_overview()); }

ExitCode new_command(const std::string& given, const GivenRock& rock, const std::optional<std::string>& out) {
    const std::string kind = full_kinds({given}).front();
    const std::string text = file_to_start_from(kind, rock);
    if (!out) return print_whole(text);
    write_whole(text, *out, "--out");
    say(stderr, "wrote {}; next: {}\n", *out, next_step(kind, *out));
    return ExitCode::success;
}

}  // namespace feldspar
