// As much of JSON Schema, Draft 4, as the schema of jobs uses. A word that is not known here is a fault of the schema, or of this
// checker.
#pragma once

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace feldspar {

class SchemaCheck {
public:
    using Json = nlohmann::json;

    explicit SchemaCheck(Json schema) : schema_(std::move(schema)) {}

    /// What a file breaks, each with its place; nothing if it fits.
    std::vector<std::string> faults(const Json& file) const {
        std::vector<std::string> found;
        check(schema_, file, "", found);
        return found;
    }

private:
    static bool is_type(const Json& value, const std::string& type) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "integer") return value.is_number_integer();
        if (type == "number") return value.is_number();
        if (type == "boolean") return value.is_boolean();
        throw std::logic_error("unknown type " + type);
    }

    void check(const Json& schema, const Json& value, const std::string& place, std::vector<std::string>& found) const {
        static const std::set<std::string> known{"$schema",
                                                 "$ref",
                                                 "title",
                                                 "description",
                                                 "definitions",
                                                 "type",
                                                 "properties",
                                                 "additionalProperties",
                                                 "required",
                                                 "items",
                                                 "minItems",
                                                 "additionalItems",
                                                 "enum",
                                                 "pattern",
                                                 "minLength",
                                                 "minimum",
                                                 "maximum",
                                                 "exclusiveMinimum",
                                                 "exclusiveMaximum",
                                                 "anyOf",
                                                 "allOf"};
        for (const auto& [word, meaning] : schema.items())
            if (!known.contains(word)) throw std::logic_error("unknown word " + word);
        const auto fault = [&](const std::string& what) { found.push_back((place.empty() ? "the file" : place) + ": " + what); };
        if (schema.contains("$ref")) {
            if (schema.size() != 1) throw std::logic_error("what stands beside a reference is not read");
            const std::string target = schema["$ref"].get<std::string>().substr(1);
            return check(schema_.at(Json::json_pointer(target)), value, place, found);
        }
        if (schema.contains("allOf"))
            for (const Json& part : schema["allOf"]) check(part, value, place, found);
        if (schema.contains("anyOf")) {
            bool fits = false;
            for (const Json& part : schema["anyOf"]) {
                std::vector<std::string> inside;
                check(part, value, place, inside);
                fits = fits || inside.empty();
            }
            if (!fits) fault("fits none of several");
        }
        if (schema.contains("type") && !is_type(value, schema["type"]))
            return fault("is no " + schema["type"].get<std::string>());
        if (schema.contains("enum") && std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
            fault("is not one of the words");
        if (value.is_string()) {
            if (schema.contains("pattern") &&
                !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
                fault("does not fit the pattern");
            if (value.get<std::string>().size() < schema.value("minLength", 0u)) fault("is too short");
        }
        if (value.is_number()) {
            const double number = value.get<double>();
            if (schema.contains("minimum") &&
                (schema.value("exclusiveMinimum", false) ? number <= schema["minimum"] : number < schema["minimum"]))
                fault("is too small");
            if (schema.contains("maximum") &&
                (schema.value("exclusiveMaximum", false) ? number >= schema["maximum"] : number > schema["maximum"]))
                fault("is too large");
        }
        if (value.is_array()) check_array(schema, value, place, found);
        if (value.is_object()) check_object(schema, value, place, found);
    }

    void check_array(const Json& schema, const Json& value, const std::string& place, std::vector<std::string>& found) const {
        if (value.size() < schema.value("minItems", 0u)) found.push_back(place + ": has too few");
        if (!schema.contains("items")) return;
        const Json& items = schema["items"];
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string at = place + "[" + std::to_string(i + 1) + "]";
            if (items.is_object())
                check(items, value[i], at, found);
            else if (i < items.size())
                check(items[i], value[i], at, found);
            else if (!schema.value("additionalItems", true))
                found.push_back(at + ": is too many");
        }
    }

    void check_object(const Json& schema, const Json& value, const std::string& place, std::vector<std::string>& found) const {
        for (const Json& key : schema.value("required", Json::array()))
            if (!value.contains(key)) found.push_back(place + ": lacks " + key.get<std::string>());
        if (!schema.contains("properties")) return;
        for (const auto& [key, inside] : value.items()) {
            if (schema["properties"].contains(key))
                check(schema["properties"][key], inside, place.empty() ? key : place + "." + key, found);
            else if (!schema.value("additionalProperties", true))
                found.push_back(place + ": unknown key " + key);
        }
    }

    Json schema_;
};

}  // namespace feldspar
