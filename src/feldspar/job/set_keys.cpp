#include "feldspar/job/set_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "feldspar/base/printable.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr std::string_view kOption = "--set ";

[[noreturn]] void refuse(const std::string& setting, const std::string& problem, const std::string& allowed = {},
                         const std::string& suggestion = {}) {
    throw InputError({place_of(setting), 0, 0, {}}, problem, allowed, suggestion);
}

std::string quoted(const std::string& text) {
    std::ostringstream stream;
    stream << toml::value<std::string>(text);
    return stream.str();
}

std::string trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
}

// The tree of one setting. Its keys and values know that they come from here.
toml::table parse_setting(const std::string& setting) {
    // the sign behind the key: one in quotes is part of a name
    std::size_t equals = 0;
    for (bool inside = false; equals < setting.size() && (inside || setting[equals] != '='); ++equals)
        if (setting[equals] == '"') inside = !inside;
    const std::string key = trimmed(std::string_view(setting).substr(0, equals));
    const std::string form = "key=value, such as material.contact.tau=30MPa";
    if (equals >= setting.size()) refuse(setting, "has no '='", form);
    const std::string value = trimmed(std::string_view(setting).substr(equals + 1));
    if (key.empty()) refuse(setting, "has no key", form);
    if (value.empty()) refuse(setting, "has no value", form);
    const std::string source = place_of(setting);
    const auto read = [&](const std::string& written) { return toml::parse(key + " = " + written, source); };
    const auto single = [](const toml::table& tree) {  // a value with a line end could bring further keys
        const toml::table* table = &tree;
        while (table->size() == 1 && table->begin()->second.is_table() && !table->begin()->second.as_table()->is_inline())
            table = table->begin()->second.as_table();
        return table->size() == 1;
    };
    if (beyond_ascii_outside_quotes(key)) refuse(setting, "'" + key + "' is not a key", form);
    const bool bare = std::string_view("[{\"'").find(value.front()) == std::string_view::npos;
    const bool strange = beyond_ascii_outside_quotes(value).has_value();
    if (strange && !bare) refuse(setting, "syntax error: a character beyond ASCII outside of quotes", form);
    if (!strange) {
        try {
            toml::table tree = read(value);
            const toml::node* node = &tree;
            while (node->is_table() && !node->as_table()->empty() && !node->as_table()->is_inline())
                node = &node->as_table()->begin()->second;
            if (single(tree) && !node->is_date() && !node->is_time() && !node->is_date_time()) return tree;
        } catch (const toml::parse_error& error) {
            if (!bare) refuse(setting, "syntax error: " + std::string(error.description()), form);
        }
    }
    try {
        return read(quoted(value));
    } catch (const toml::parse_error& error) {
        refuse(setting, "'" + key + "' is not a key: " + std::string(error.description()), form);
    }
}

// Values are moved: a copy would forget that it comes from a setting.
void lay(toml::table& under, toml::table&& over, const std::string& setting, const std::string& path) {
    for (auto&& [key, value] : over) {
        toml::node* there = under.get(key.str());
        const std::string full = path.empty() ? std::string(key.str()) : path + "." + std::string(key.str());
        if (value.is_table() && !value.as_table()->is_inline() && there != nullptr) {
            if (!there->is_table()) refuse(setting, "'" + full + "' is not a table in the job, so it has no keys");
            lay(*there->as_table(), std::move(*value.as_table()), setting, full);
        } else {
            under.insert_or_assign(key, std::move(value));
        }
    }
}

std::vector<std::size_t> tables_with(const toml::array& list, std::string_view key, std::string_view word) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (const toml::table* table = list.get(i)->as_table();
            table != nullptr && (*table)[key].value<std::string_view>() == word)
            found.push_back(i);
    return found;
}

// The tables of a list that a word of a setting names; none if it is one of their keys.
std::vector<std::size_t> named_tables(const toml::array& list, std::string_view list_name, std::string_view word,
                                      const std::string& setting) {
    if (list_name != "test") return tables_with(list, "name", word);
    const auto method = find_method_called(word);
    if (!method) return {};
    std::vector<std::size_t> found = tables_with(list, "kind", name(*method));
    if (found.empty()) refuse(setting, "the job has no test '" + std::string(name(*method)) + "'");
    return found;
}

// A key of each table of a list, or of those that the setting names.
void set_in_list(toml::array& list, const std::string& list_name, const std::string& setting) {
    const toml::table tree = parse_setting(setting);
    const auto first = tree.begin()->second.as_table()->begin();
    const std::string word(first->first.str());
    std::vector<std::size_t> chosen;
    if (first->second.is_table()) chosen = named_tables(list, list_name, word, setting);
    const bool named = !chosen.empty();
    for (std::size_t i = 0; !named && i < list.size(); ++i) chosen.push_back(i);
    for (const std::size_t i : chosen) {
        toml::table again = parse_setting(setting);  // to be moved from
        toml::table& inside = *again.begin()->second.as_table();
        toml::table* table = list.get(i)->as_table();
        if (table != nullptr)
            lay(*table, std::move(named ? *inside.get(word)->as_table() : inside), setting,
                named ? fmt::format("{}.{}", list_name, word) : list_name);
    }
}

}  // namespace

bool is_setting(const toml::source_region& region) { return region.path && region.path->starts_with(kOption); }
bool is_setting(const InputPlace& place) { return place.file.starts_with(kOption); }

std::string place_of(const std::string& setting) { return std::string(kOption) + "'" + setting + "'"; }

std::vector<std::string> key_of(const std::string& setting) {
    const toml::table tree = parse_setting(setting);
    std::vector<std::string> words;
    for (const toml::table* table = &tree; table != nullptr && !table->empty() && (table == &tree || !table->is_inline());
         table = table->begin()->second.as_table())
        words.emplace_back(table->begin()->first.str());
    return words;
}

std::string with_settings(const std::string& text, std::span<const std::string> settings) {
    if (settings.empty()) return text;
    std::string whole = text + ((text.empty() || text.back() == '\n') ? "\n" : "\n\n");
    whole += "# set on the command line, over what stands above:\n";
    for (const std::string& setting : settings) whole += "# --set " + printable(setting, LineEnds::escaped) + "\n";
    return whole;
}

void set_keys(toml::table& job, std::span<const std::string> settings) {
    for (const std::string& setting : settings) {
        toml::table tree = parse_setting(setting);
        const std::string key(tree.begin()->first.str());
        const toml::node& value = tree.begin()->second;
        toml::node* there = job.get(key);
        toml::array* list = there != nullptr ? there->as_array() : nullptr;
        if (list != nullptr && value.is_table() && !value.as_table()->is_inline())
            set_in_list(*list, key, setting);
        else
            lay(job, std::move(tree), setting, {});
    }
}

}  // namespace feldspar
