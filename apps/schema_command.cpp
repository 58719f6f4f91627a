#include <filesystem>

#include "commands.hpp"
#include "feldspar/job/key_reference.hpp"
#include "feldspar/job/schema.hpp"
#include "say.hpp"
#include "whole_text.hpp"

namespace feldspar {

ExitCode schema_command(bool markdown, const std::optional<std::string>& out) {
    const std::string text = markdown ? key_reference() : job_schema();
    if (!out) return print_whole(text);
    write_whole(text, *out, "--out");
    if (markdown)
        say(stderr, "wrote {}\n", *out);
    else
        say(stderr, "wrote {}; the first line of a job beside it: #:schema ./{}\n", *out,
            std::filesystem::path(*out).filename().string());
    return ExitCode::success;
}

}  // namespace feldspar
