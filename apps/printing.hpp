// What the commands that run tests print where, as --json and --quiet say.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "feldspar/base/error.hpp"
#include "say.hpp"
#include "terminal.hpp"

namespace feldspar {

using Json = nlohmann::ordered_json;

struct PrintOptions {
    bool json = false;   ///< one object on standard output at the end, and all else on standard error
    bool quiet = false;  ///< only warnings, mistakes and failures, and at the end where the results are
};

class Printing {
public:
    explicit Printing(const PrintOptions& options) : options_(options) {}

    bool quiet() const { return options_.quiet; }
    bool json() const { return options_.json; }
    /// Where results go, and how wide it is: standard output, beside an object standard error.
    std::FILE* results() const { return options_.json ? stderr : stdout; }
    std::size_t columns() const { return options_.json ? error_columns() : output_columns(); }

    /// Results for a reader. Nothing is said if it is to be quiet.
    template <class... Values>
    void say_results(fmt::format_string<Values...> format, Values&&... values) const {
        if (!options_.quiet) say(results(), format, std::forward<Values>(values)...);
    }

    /// The end of a command: the object, if one is asked for; else, if it is quiet, the directory of its results.
    /// @param object  makes it; called only where it is wanted
    void end(const std::filesystem::path& directory, const std::function<Json()>& object);

    /// Whether end() has printed the object.
    bool object_printed() const { return printed_; }
    void print_object(const Json& object);

private:
    PrintOptions options_;
    bool printed_ = false;
};

/// Calls a command. With --json, what it throws before its object is printed becomes an object, too: {"error": {"kind": "input",
/// "message", "file", "line", "column", "key"}}; kinds "numerical", "output" and "interrupted" have a message alone.
ExitCode printing(const PrintOptions& options, const std::function<ExitCode(Printing&)>& command);

/// An object with what a file of JSON holds behind it. @throws OutputError if it cannot be read
Json with_file(Json object, const std::filesystem::path& file);

}  // namespace feldspar
