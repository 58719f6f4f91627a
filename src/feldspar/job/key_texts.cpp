// What the rows of keys.cpp say in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "feldspar/job/keys.hpp"

namespace feldspar {
namespace {

using enum Dimension;

// "6.25e-9"
std::string short_number(double value) {
    std::string text = fmt::format("{:.12g}", value);
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

// Words that stand in quotes in a file.
std::string quoted(const std::vector<std::string>& words) {
    std::vector<std::string> in_quotes;
    for (const std::string& word : words) in_quotes.push_back(fmt::format("\"{}\"", word));
    return fmt::format("{}", fmt::join(in_quotes, ", "));
}

std::string bounded(std::string_view what, const Range& range) {
    return range.words == any_value.words ? std::string(what) : fmt::format("{}, {}", what, range.words);
}

// Of a dimension: the unit in which people read it.
std::string_view unit_of(const KeyValue& value) {
    if (!value.unit.empty() || value.element.form != ValueForm::quantity) return value.unit;
    switch (value.element.dimension) {
        case length:
            return "mm";
        case stress:
            return "MPa";
        case density:
            return "kg/m3";
        case stiffness_gradient:
            return "GPa/m";
        case fracture_energy:
            return "N/m";
        case speed:
            return "m/s";
        case speed_per_step:
            return "m/step";
        case Dimension::time:
            return "s";
        case angle:
            return "deg";
        case force:
            return "kN";
        case energy:
            return "J";
        case acceleration:
            return "m/s2";
        case toughness:
            return "MPa m^0.5";
        case fraction:
            break;
    }
    return "";
}

std::string element_text(const KeyElement& element) {
    const std::string others = element.words.empty() ? "" : quoted(element.words) + ", or ";
    switch (element.form) {
        case ValueForm::quantity:
            return others + bounded(describe(element.dimension), element.range);
        case ValueForm::number:
            return others + bounded("a number", element.range);
        case ValueForm::fraction:
            return others + bounded("a fraction", element.range);
        case ValueForm::integer:
            return others + (std::isinf(element.range.high)
                                 ? fmt::format("a whole number, {:g} or greater", element.range.low)
                                 : fmt::format("a whole number from {:g} to {:g}", element.range.low, element.range.high));
        case ValueForm::flag:
            return "true, false";
        case ValueForm::text:
            return std::string(element.range.words);
        case ValueForm::choice:
            return quoted(element.words);
        case ValueForm::table:
            break;
    }
    return "a table";
}

}  // namespace

std::string as_written(const KeyValue& value, double si) {
    if (value.element.form == ValueForm::flag) return si != 0.0 ? "true" : "false";
    const std::string_view unit = unit_of(value);
    if (unit.empty()) return format_exact(si);
    return fmt::format("\"{} {}\"", short_number(si / parse_quantity(fmt::format("1 {}", unit), value.element.dimension)), unit);
}

std::string allowed(const JobKey& key) {
    const KeyValue& value = key.value;
    std::string one = element_text(value.element);
    switch (value.shape) {
        case ValueShape::one:
            return one;
        case ValueShape::list:
            return (value.element.form == ValueForm::choice ? "a list, each one of " : "a list, each ") + one;
        case ValueShape::one_or_list:
            return one + "; or a list of them";
        case ValueShape::pairs:
            return fmt::format("a list of pairs: {}; {}", one, element_text(*value.second));
        case ValueShape::tables:
            break;
    }
    return "a list of tables";
}

std::string usual_text(const JobKey& key) {
    if (key.usual.value) return as_written(key.value, *key.usual.value);
    return key.usual.toml.empty() ? key.usual.words : key.usual.toml;
}

std::string condition_text(const JobKey& key) {
    if (key.when.key.empty()) return {};
    const std::size_t dot = key.when.key.rfind('.');
    return fmt::format("{} = {}", dot == std::string_view::npos ? key.when.key : key.when.key.substr(dot + 1),
                       quoted(key.when.words));
}

std::string applies_text(const JobKey& key) {
    std::string text = key.applies;
    if (!key.when.key.empty()) {
        const std::size_t dot = key.when.key.rfind('.');
        const std::string table = dot == std::string_view::npos ? "" : fmt::format("[{}] ", key.when.key.substr(0, dot));
        text += fmt::format("{}with `{}{}`", text.empty() ? "" : ", ", table, condition_text(key));
    }
    if (key.of_plates) text += text.empty() ? "where plates load the specimen" : ", where plates load the specimen";
    return text;
}

std::string without_markup(std::string_view marked) {
    static const std::regex link_in_brackets(R"( ?\(\[[^\]]*\]\([^)]*\)\))");
    const std::string markdown = std::regex_replace(std::string(marked), link_in_brackets, "");
    std::string text;
    bool code = false;
    for (std::size_t i = 0; i < markdown.size(); ++i) {
        const char c = markdown[i];
        if (c == '`') {
            code = !code;
        } else if (code || (c != '[' && c != ']')) {
            text += c;
        } else if (markdown.compare(i, 2, "](") == 0) {
            i = std::min(markdown.find(')', i), markdown.size());
        }
    }
    return text;
}

}  // namespace feldspar
