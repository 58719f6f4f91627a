#include "command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "feldspar/base/printable.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "say.hpp"

namespace feldspar {
namespace {

std::vector<const CLI::App*> commands_in(const CLI::App& app) {
    std::vector<const CLI::App*> commands;
    for (const CLI::App* inside : app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
        commands.push_back(inside);
    return commands;
}

std::string full_name(const CLI::App& app) {
    return app.get_parent() == nullptr ? app.get_name() : full_name(*app.get_parent()) + " " + app.get_name();
}

// The command that a command line is for, by its words: the innermost one that they name.
const CLI::App* command_of(const CLI::App& app, int argc, char** argv) {
    const CLI::App* command = &app;
    for (int i = 1; i < argc; ++i) {
        const std::vector<const CLI::App*> inside = commands_in(*command);
        const auto found = std::ranges::find_if(inside, [&](const CLI::App* one) { return one->get_name() == argv[i]; });
        if (found != inside.end())
            command = *found;
        else if (command == &app && argv[i][0] != '-')
            break;  // no command
    }
    return command;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
    const std::vector<std::string_view> views(candidates.begin(), candidates.end());
    return did_you_mean(word, views);
}

// The words of the command line that nobody expected.
std::vector<std::string> unexpected(const CLI::App& app, const CLI::App& command, int argc, char** argv) {
    std::vector<std::string> words;
    if (&command == &app && argc > 1 && argv[1][0] != '-') return {argv[1]};
    const std::vector<std::string> known = option_names(command);
    for (int i = 1; i < argc; ++i) {
        const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
        if (word.size() > 2 && word.starts_with("--") && std::ranges::find(known, word) == known.end()) words.push_back(word);
    }
    return words;
}

}  // namespace

bool told(const CLI::Option& option) {
    return !option.get_group().empty() && option.get_name() != "--help" && option.get_name().find("--help") == std::string::npos;
}

std::string value_name(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return type.substr(0, type.find(':'));  // without what its check says of it
}

std::string written(const CLI::Option& option) {
    const bool positional = option.get_positional();
    const std::string type = value_name(option);
    std::string text = positional ? type : option.get_name();
    if (!positional && !type.empty() && option.get_items_expected_max() > 0) text += " " + type;
    return text;
}

CommandLine::CommandLine(std::string text, const char* examples, std::function<std::string()> version) : text_(std::move(text)) {
    app_.footer(examples);
    app_.require_subcommand(1);
    app_.set_version_flag("--version", std::move(version), "print version, commit and compiler");
}

CLI::App& CommandLine::add(CLI::App& inside, const char* name, const char* what, const char* examples) {
    CLI::App& command = *inside.add_subcommand(name, what);
    if (examples[0] != '\0') command.footer(std::string("Examples:\n") + examples);
    return command;
}

const std::vector<std::string>& CommandLine::choices(const CLI::Option* option) const {
    static const std::vector<std::string> none;
    const auto found = choices_.find(option);
    return found == choices_.end() ? none : found->second;
}

std::vector<CommandPage> CommandLine::pages() const {
    std::vector<CommandPage> pages;
    const std::function<void(const CLI::App&, const std::string&)> walk = [&](const CLI::App& app, const std::string& name) {
        const std::vector<const CLI::App*> inside = commands_in(app);
        pages.push_back({&app, name, inside});
        for (const CLI::App* one : inside) walk(*one, name.empty() ? one->get_name() : name + " " + one->get_name());
    };
    walk(app_, "");
    return pages;
}

// In sentences, with what was probably meant, and where to read on.
int CommandLine::refuse(int argc, char** argv, const CLI::ParseError& error) const {
    const CLI::App& command = *command_of(app_, argc, argv);
    const std::vector<std::string> strange = unexpected(app_, command, argc, argv);
    std::string text = error.what(), hint;
    if (argc < 2) {
        text = "a command is required";
        hint = "'feldspar new laboratory --out rock.toml' writes a first job, 'feldspar run rock.toml' runs it";
    } else if (&command == &app_ && !strange.empty()) {
        std::vector<std::string> names;
        for (const CLI::App* one : commands_in(app_)) names.push_back(one->get_name());
        text = fmt::format("'{}' is not a command", strange.front());
        hint = suggestion(strange.front(), names);
    } else if (!strange.empty()) {
        text = fmt::format("'{}' is not an option of '{}'", strange.front(), full_name(command));
        hint = suggestion(strange.front(), option_names(command));
    } else if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
        text = fmt::format("'{}' takes no further argument ({})", full_name(command), text);
    } else if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        std::vector<std::string> missing;
        for (const CLI::Option* option : command.get_options())
            if (option->get_required() && option->count() == 0) missing.push_back(written(*option));
        if (!missing.empty()) text = fmt::format("'{}' needs {}", full_name(command), fmt::join(missing, " and "));
    }
    put(stderr, printable(fmt::format("feldspar: {}\n", text)));
    if (!hint.empty()) put(stderr, printable(fmt::format("  {}\n", hint)));
    put(stderr, fmt::format("  '{} --help' shows {}\n", full_name(command),
                            &command == &app_ ? "the commands with examples" : "its options with examples"));
    return static_cast<int>(ExitCode::input);
}

int CommandLine::run(int argc, char** argv, const std::function<int(const Action&)>& guarded) {
    try {
        app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app_.exit(error);  // --help, --version
        return refuse(argc, argv, error);
    }
    for (const auto& [command, action] : actions_)
        if (command->parsed()) return guarded(action);
    return static_cast<int>(ExitCode::input);  // not reached: one command is required
}

}  // namespace feldspar
