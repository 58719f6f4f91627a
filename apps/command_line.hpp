// The commands of the program as a tree: what is parsed, what is said of mistakes, and what manual pages and completions are
// written from.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"

namespace feldspar {

/// A command of the tree as manual pages and completions see it.
struct CommandPage {
    const CLI::App* app;
    std::string name;                     ///< with those before it: "study status"
    std::vector<const CLI::App*> inside;  ///< commands in it that users call
};

/// The commands, each with what it does. What follows from the command line lives in the action, as long as it may be called.
class CommandLine {
public:
    using Action = std::function<ExitCode()>;

    /// @param text      the whole command line
    /// @param examples  below the help of the whole program
    CommandLine(std::string text, const char* examples, std::function<std::string()> version);

    /// A new command. @param examples  lines of "command   what it does", below its help
    CLI::App& add(const char* name, const char* what, const char* examples) { return add(app_, name, what, examples); }
    /// The same inside another one.
    CLI::App& add(CLI::App& inside, const char* name, const char* what, const char* examples);

    /// What a command does; of a command inside another before that of the other.
    void does(CLI::App& command, Action action) { actions_.emplace_back(&command, std::move(action)); }

    /// The words that the values of an option may be, for completion.
    void choices(const CLI::Option* option, std::vector<std::string> words) { choices_[option] = std::move(words); }
    const std::vector<std::string>& choices(const CLI::Option* option) const;

    /// New options that know the whole command line, for provenance.
    template <class Options>
    std::shared_ptr<Options> options() const {
        auto options = std::make_shared<Options>();
        options->command_line = text_;
        return options;
    }

    /// All commands that users call, the program itself first.
    std::vector<CommandPage> pages() const;

    /// Parses, and does what is asked by `guarded(action)`. @return the exit code
    int run(int argc, char** argv, const std::function<int(const Action&)>& guarded);

private:
    int refuse(int argc, char** argv, const CLI::ParseError& error) const;

    CLI::App app_{"A laboratory for rock fracture with the flexible particle model.", "feldspar"};
    std::string text_;
    std::vector<std::pair<CLI::App*, Action>> actions_;
    std::map<const CLI::Option*, std::vector<std::string>> choices_;
};

/// Whether an option is for users, and no `--help`.
bool told(const CLI::Option& option);

/// What its value is called: "DIR".
std::string value_name(const CLI::Option& option);

/// "--out DIR", "-h,--help": an option, or the name of a positional one.
std::string written(const CLI::Option& option);

}  // namespace feldspar
