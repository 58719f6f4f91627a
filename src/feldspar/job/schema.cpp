#include "feldspar/job/schema.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "feldspar/job/keys.hpp"

namespace feldspar {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* number_with_unit = R"(^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*[^\s0-9.,+-].*$)";
constexpr const char* number_with_percent = R"(^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*(%|percent)?\s*$)";

// Bounds of Draft 4, where an exclusive one is a flag beside it.
Json bounded(Json type, const Range& range) {
    if (std::isfinite(range.low)) {
        type["minimum"] = range.low;
        if (!range.low_allowed) type["exclusiveMinimum"] = true;
    }
    if (std::isfinite(range.high)) {
        type["maximum"] = range.high;
        if (!range.high_allowed) type["exclusiveMaximum"] = true;
    }
    return type;
}

Json whole(const Range& range) {
    Json type{{"type", "integer"}};
    if (std::isfinite(range.low)) type["minimum"] = static_cast<long long>(range.low);
    if (std::isfinite(range.high)) type["maximum"] = static_cast<long long>(range.high);
    return type;
}

std::string name_of(std::string_view table) { return table.empty() ? "job" : std::string(table); }
Json reference(std::string_view table) { return {{"$ref", "#/definitions/" + name_of(table)}}; }

Json value_of(const KeyElement& element) {
    switch (element.form) {
        case ValueForm::quantity:
            if (element.dimension == Dimension::fraction)  // of keys whose dimension another one decides
                return {{"anyOf",
                         {{{"type", "string"}, {"pattern", number_with_unit}},
                          {{"type", "string"}, {"pattern", number_with_percent}}}}};
            return {{"type", "string"}, {"pattern", number_with_unit}};
        case ValueForm::number:
            return bounded({{"type", "number"}}, element.range);
        case ValueForm::fraction:
            return {{"anyOf",
                     {bounded({{"type", "number"}}, element.range), {{"type", "string"}, {"pattern", number_with_percent}}}}};
        case ValueForm::integer:
            return whole(element.range);
        case ValueForm::flag:
            return {{"type", "boolean"}};
        case ValueForm::text:
            return {{"type", "string"}, {"minLength", 1}};
        case ValueForm::choice:
            return {{"type", "string"}, {"enum", element.words}};
        case ValueForm::table:
            break;
    }
    return reference(element.table);
}

// A value, or a word that may stand in its place.
Json element_of(const KeyElement& element) {
    if (element.words.empty() || element.form == ValueForm::choice) return value_of(element);
    return {{"anyOf", {value_of(element), {{"type", "string"}, {"enum", element.words}}}}};
}

Json array_of(Json items, int least) { return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}}; }

Json type_of(const KeyValue& value) {
    Json one = element_of(value.element);
    switch (value.shape) {
        case ValueShape::one:
            return one;
        case ValueShape::one_or_list:
            return {{"anyOf", {one, array_of(one, 1)}}};
        case ValueShape::pairs: {
            Json pair = array_of(Json::array({one, element_of(*value.second)}), 2);
            pair["additionalItems"] = false;
            return array_of(std::move(pair), 0);
        }
        case ValueShape::list:
        case ValueShape::tables:
            break;
    }
    return array_of(one, 1);
}

std::string sentence(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z' && (text.size() < 2 || text[1] < 'A' || text[1] > 'Z'))
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return text + ".";
}

std::string description_of(const JobKey& key) {
    const std::string applies = without_markup(applies_text(key));
    std::string text = sentence(without_markup(key.meaning));
    if (!applies.empty()) text += fmt::format(" Only {}.", applies);
    if (key.value.element.form != ValueForm::table) text += fmt::format(" Allowed: {}.", allowed(key));
    if (key.usual.is_value()) return text + fmt::format(" Default: {}.", usual_text(key));
    const std::string words = without_markup(key.usual.words);
    return text + (words.starts_with("must") ? " " + sentence(words) : fmt::format(" Default: {}.", words));
}

Json property_of(const JobKey& key) {
    const std::string description = description_of(key);
    Json property = type_of(key.value);
    if (property.contains("$ref")) property = {{"allOf", Json::array({property})}};  // what stands beside a reference is not read
    property["description"] = description;
    return property;
}

Json object_of(const KeyTable& table) {
    Json properties = Json::object(), needed = Json::array();
    for (const JobKey& key : table.keys) {
        properties[std::string(key.name)] = property_of(key);
        if (key.usual.need == KeyNeed::always) needed.push_back(key.name);
    }
    Json object{{"type", "object"},
                {"description", sentence(without_markup(table.meaning))},
                {"properties", std::move(properties)},
                {"additionalProperties", false}};
    if (!needed.empty()) object["required"] = std::move(needed);
    return object;
}

}  // namespace

std::string job_schema() {
    Json definitions = Json::object();
    for (const KeyTable& table : job_tables())
        if (!table.path.empty()) definitions[name_of(table.path)] = object_of(table);
    Json schema{{"$schema", "http://json-schema.org/draft-04/schema#"}, {"title", "Feldspar job"}};
    schema.update(object_of(job_table("")));
    schema["description"] = "A job of Feldspar: specimen, model, material, numerics, tests. Quantities are text with a unit.";
    schema["definitions"] = std::move(definitions);
    return schema.dump(2) + "\n";
}

}  // namespace feldspar
