#include "command_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "feldspar/output/results.hpp"

namespace feldspar {
namespace {

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

// Text that roff is to print as it stands.
std::string roff(const std::string& text) {
    std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    std::string lines;
    std::istringstream stream(safe);
    for (std::string line; std::getline(stream, line);)
        lines += (line.starts_with(".") || line.starts_with("'") ? "\\&" : "") + line + "\n";
    return lines;
}

std::string page_name(const std::string& command) {
    return command.empty() ? "feldspar" : "feldspar-" + replaced(command, " ", "-");
}

// What a value of an option is completed by.
enum class Kind { none, words, toml, directory, file };

Kind kind_of(const CommandLine& line, const CLI::Option& option) {
    if (!line.choices(&option).empty()) return Kind::words;
    const std::string type = value_name(option);
    if (type.ends_with(".toml")) return Kind::toml;
    if (type == "DIR" || type == "RUN" || type == "FOLDER") return Kind::directory;
    return type == "FILE" ? Kind::file : Kind::none;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    std::vector<const CLI::Option*> options;
    for (const CLI::Option* option : app.get_options())
        if (told(*option) && !option->get_positional()) options.push_back(option);
    return options;
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& app) {
    std::vector<const CLI::Option*> options;
    for (const CLI::Option* option : app.get_options())
        if (told(*option) && option->get_positional()) options.push_back(option);
    return options;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<std::string> names_of(const std::vector<const CLI::App*>& apps) {
    std::vector<std::string> names;
    for (const CLI::App* app : apps) names.push_back(app->get_name());
    return names;
}

std::string bash(const CommandLine& line) {
    std::string text =
        "# bash completion of feldspar, written by 'feldspar completion bash'\n"
        "_feldspar() {\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= i\n"
        "    COMPREPLY=()\n"
        "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
        "        case \"$command ${COMP_WORDS[i]}\" in\n";
    for (const CommandPage& page : line.pages())
        if (!page.name.empty())
            text += fmt::format("            \"{}{}\") command=\"{}\" ;;\n", page.name.find(' ') == std::string::npos ? " " : "",
                                page.name, page.name);
    text +=
        "        esac\n    done\n"
        "    local options= commands= files=\n"
        "    case \"$command\" in\n";
    for (const CommandPage& page : line.pages()) {
        text += fmt::format("    \"{}\")\n", page.name);
        std::vector<std::string> flags{"--help"};
        std::string values;
        for (const CLI::Option* option : options_of(*page.app)) {
            std::vector<std::string> names;
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
            flags.insert(flags.end(), names.begin(), names.end());
            if (!takes_value(*option)) continue;
            std::string answer = "return";
            switch (kind_of(line, *option)) {
                case Kind::words:
                    answer = fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return",
                                         fmt::join(line.choices(option), " "));
                    break;
                case Kind::directory:
                    answer = "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$word\")); return";
                    break;
                case Kind::toml:
                case Kind::file:
                    answer = "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$word\")); return";
                    break;
                case Kind::none:
                    break;
            }
            values += fmt::format("        {}) {} ;;\n", fmt::join(names, "|"), answer);
        }
        if (!values.empty()) text += "        case \"$before\" in\n" + values + "        esac\n";
        std::vector<std::string> words = names_of(page.inside);
        std::string files;
        for (const CLI::Option* option : positionals_of(*page.app)) {
            const std::vector<std::string>& choices = line.choices(option);
            words.insert(words.end(), choices.begin(), choices.end());
            const Kind kind = kind_of(line, *option);
            if (kind == Kind::toml) files = "toml";
            if (kind == Kind::directory) files = "directory";
            if (kind == Kind::file) files = "file";
        }
        text += fmt::format("        options=\"{}\" commands=\"{}\" files={}\n        ;;\n", fmt::join(flags, " "),
                            fmt::join(words, " "), files);
    }
    return text +
           "    esac\n"
           "    if [[ $word == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
           "        return\n"
           "    fi\n"
           "    COMPREPLY=($(compgen -W \"$commands\" -- \"$word\"))\n"
           "    [[ -z $files ]] || compopt -o filenames\n"
           "    case $files in\n"
           "    toml) COMPREPLY+=($(compgen -d -- \"$word\") $(compgen -f -X '!*.toml' -- \"$word\")) ;;\n"
           "    directory) COMPREPLY+=($(compgen -d -- \"$word\")) ;;\n"
           "    file) COMPREPLY+=($(compgen -f -- \"$word\")) ;;\n"
           "    esac\n"
           "}\n"
           "complete -F _feldspar feldspar\n";
}

// Inside single quotes, and inside a description of _arguments.
std::string zsh_text(const std::string& text) {
    return replaced(replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "'", "'\\''"), "[", "\\["), "]", "\\]"), ":", "\\:");
}

std::string zsh_values(const CommandLine& line, const CLI::Option& option) {
    switch (kind_of(line, option)) {
        case Kind::words:
            return fmt::format("({})", fmt::join(line.choices(&option), " "));
        case Kind::toml:
            return "_files -g \"*.toml\"";
        case Kind::directory:
            return "_files -/";
        case Kind::file:
            return "_files";
        case Kind::none:
            break;
    }
    return " ";
}

std::string zsh_function(const std::string& command) {
    return command.empty() ? "_feldspar" : "_feldspar_" + replaced(replaced(command, " ", "_"), "-", "_");
}

std::string zsh(const CommandLine& line) {
    std::string text = "#compdef feldspar\n# zsh completion of feldspar, written by 'feldspar completion zsh'\n";
    for (const CommandPage& page : line.pages()) {
        text += fmt::format("\n{}() {{\n", zsh_function(page.name));
        if (!page.inside.empty()) text += "    local context state line\n    typeset -A opt_args\n";
        text += fmt::format("    _arguments {}\\\n        '--help[print this help and exit]'", page.inside.empty() ? "" : "-C ");
        for (const CLI::Option* option : options_of(*page.app))
            for (const std::string& name : option->get_lnames()) {
                text += fmt::format(" \\\n        '*--{}[{}]", name, zsh_text(option->get_description()));
                if (takes_value(*option)) text += fmt::format(":{}:{}", zsh_text(value_name(*option)), zsh_values(line, *option));
                text += "'";
            }
        if (page.inside.empty())
            for (const CLI::Option* option : positionals_of(*page.app))
                text += fmt::format(" \\\n        ':{}:{}'", zsh_text(value_name(*option)), zsh_values(line, *option));
        else
            text += " \\\n        '1: :->command' \\\n        '*:: :->rest'";
        text += "\n";
        if (!page.inside.empty()) {
            text += "    case $state in\n    command)\n        local -a commands=(";
            for (const CLI::App* inside : page.inside)
                text += fmt::format("\n            '{}:{}'", inside->get_name(), zsh_text(inside->get_description()));
            text += "\n        )\n        _describe command commands\n";
            for (const CLI::Option* option : positionals_of(*page.app))
                text += fmt::format("        {}\n", kind_of(line, *option) == Kind::toml ? "_files -g \"*.toml\"" : "_files");
            text += "        ;;\n    rest)\n        case $line[1] in\n";
            for (const CLI::App* inside : page.inside)
                text += fmt::format("        {}) {} ;;\n", inside->get_name(),
                                    zsh_function(page.name.empty() ? inside->get_name() : page.name + " " + inside->get_name()));
            text += "        esac\n        ;;\n    esac\n";
        }
        text += "}\n";
    }
    return text + "\nif [[ $funcstack[1] == _feldspar ]]; then\n    _feldspar \"$@\"\nelse\n    compdef _feldspar feldspar\nfi\n";
}

std::string fish(const CommandLine& line) {
    const auto quoted = [](const std::string& text) { return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'"; };
    std::string text = "# fish completion of feldspar, written by 'feldspar completion fish'\ncomplete -c feldspar -f\n";
    for (const CommandPage& page : line.pages()) {
        std::vector<std::string> words;
        std::istringstream stream(page.name);
        for (std::string word; stream >> word;) words.push_back(word);
        std::string when = "__fish_use_subcommand";
        if (!words.empty()) {
            when = fmt::format("__fish_seen_subcommand_from {}", words.front());
            for (std::size_t w = 1; w < words.size(); ++w) when += fmt::format("; and __fish_seen_subcommand_from {}", words[w]);
            if (!page.inside.empty())
                when += fmt::format("; and not __fish_seen_subcommand_from {}", fmt::join(names_of(page.inside), " "));
        }
        const auto add = [&](const std::string& rest) { text += fmt::format("complete -c feldspar -n \"{}\" {}\n", when, rest); };
        for (const CLI::App* inside : page.inside)
            add(fmt::format("-a {} -d {}", inside->get_name(), quoted(inside->get_description())));
        for (const CLI::Option* option : options_of(*page.app))
            for (const std::string& name : option->get_lnames()) {
                std::string values;
                if (takes_value(*option)) {
                    switch (kind_of(line, *option)) {
                        case Kind::words:
                            values = fmt::format(" -x -a {}", quoted(fmt::format("{}", fmt::join(line.choices(option), " "))));
                            break;
                        case Kind::directory:
                            values = " -x -a '(__fish_complete_directories)'";
                            break;
                        case Kind::toml:
                        case Kind::file:
                            values = " -r -F";
                            break;
                        case Kind::none:
                            values = " -x";
                            break;
                    }
                }
                add(fmt::format("-l {}{} -d {}", name, values, quoted(option->get_description())));
            }
        for (const CLI::Option* option : positionals_of(*page.app)) {
            if (!line.choices(option).empty())
                add(fmt::format("-a {}", quoted(fmt::format("{}", fmt::join(line.choices(option), " ")))));
            const Kind kind = kind_of(line, *option);
            if (kind == Kind::toml) add("-a '(__fish_complete_suffix .toml)'");
            if (kind == Kind::directory) add("-a '(__fish_complete_directories)'");
            if (kind == Kind::file) add("-F");
        }
    }
    return text;
}

}  // namespace

std::vector<std::string> manual_names(const CommandLine& line) {
    std::vector<std::string> names;
    for (const CommandPage& page : line.pages()) names.push_back(page_name(page.name));
    return names;
}

std::string manual_page_named(const CommandLine& line, const std::string& page) {
    for (const CommandPage& one : line.pages())
        if (page_name(one.name) == page) return manual_page(line, one.name);
    throw InputError({{}, 0, 0, "--page"}, fmt::format("'{}' is not a page", page),
                     "a page, as 'feldspar manual --list' prints them");
}

std::string manual_page(const CommandLine& line, const std::string& name) {
    const std::vector<CommandPage> pages = line.pages();
    const auto found = std::ranges::find_if(pages, [&](const CommandPage& page) { return page.name == name; });
    if (found == pages.end())
        throw InputError({}, fmt::format("'{}' is not a command", name), "a command, as 'feldspar --help' lists them");
    const CommandPage& page = *found;
    const std::vector<const CLI::Option*> options = options_of(*page.app), positionals = positionals_of(*page.app);
    const std::string command = name.empty() ? "feldspar" : "feldspar " + name;
    std::string head = page_name(name);
    std::ranges::transform(head, head.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });

    std::string text =
        fmt::format(".TH {} 1 \"\" \"feldspar {}\" \"User commands\"\n.SH NAME\n{} \\- {}", head,
                    collect_provenance("", 1).version, replaced(page_name(name), "-", "\\-"), roff(page.app->get_description()));
    text += fmt::format(".SH SYNOPSIS\n.B {}\n", replaced(command, "-", "\\-"));
    if (!options.empty()) text += "[\\fIoptions\\fR]\n";
    for (const CLI::Option* option : positionals)
        text += fmt::format("{}\\fI{}\\fR{}\n", option->get_required() ? "" : "[", value_name(*option),
                            option->get_required() ? "" : "]");
    if (!page.inside.empty())
        text += positionals.empty() ? "\\fIcommand\\fR ...\n"
                                    : fmt::format(".br\n.B {}\n\\fIcommand\\fR ...\n", replaced(command, "-", "\\-"));
    if (!positionals.empty()) text += ".SH ARGUMENTS\n";
    for (const CLI::Option* option : positionals)
        text += fmt::format(".TP\n\\fI{}\\fR\n{}", value_name(*option), roff(option->get_description()));
    if (!page.inside.empty()) text += ".SH COMMANDS\n";
    for (const CLI::App* inside : page.inside)
        text += fmt::format(".TP\n.B {}\n{}", replaced(inside->get_name(), "-", "\\-"), roff(inside->get_description()));
    text += ".SH OPTIONS\n";
    for (const CLI::Option* option : options)
        text += fmt::format(".TP\n.B {}\n{}", replaced(written(*option), "-", "\\-"), roff(option->get_description()));
    text += ".TP\n.B \\-\\-help\nprint a help with examples and exit\n";
    if (std::string examples = page.app->get_footer(); !examples.empty()) {
        if (examples.starts_with("Examples:\n")) examples.erase(0, std::string_view("Examples:\n").size());
        examples = examples.substr(0, examples.find("\nExit codes:"));
        text += ".SH EXAMPLES\n.nf\n" + roff(examples) + ".fi\n";
    }
    text +=
        ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n2\na mistake in the input, found before the run; no file is left\n.TP\n3\nnumerical "
        "failure\n.TP\n4\nresults could not be written\n.TP\n130\ninterrupted; the results so far are kept\n";
    text += ".SH SEE ALSO\n";
    std::vector<std::string> others;
    if (!name.empty()) others.push_back(name.find(' ') == std::string::npos ? "" : name.substr(0, name.rfind(' ')));
    for (const CLI::App* inside : page.inside)
        others.push_back(name.empty() ? inside->get_name() : name + " " + inside->get_name());
    for (std::size_t i = 0; i < others.size(); ++i)
        text += fmt::format(".BR {} (1){}\n", replaced(page_name(others[i]), "-", "\\-"), i + 1 < others.size() ? "," : "");
    return text;
}

std::string completion(const CommandLine& line, const std::string& shell) {
    return shell == "bash" ? bash(line) : shell == "zsh" ? zsh(line) : fish(line);
}

}  // namespace feldspar
