// The units of the user's in a job that is written out in full.
#include <array>
#include <regex>

#include "feldspar/base/units.hpp"
#include "feldspar/job/format.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/job/toml_reader.hpp"

namespace feldspar {
namespace {

constexpr std::array dimensions{
    Dimension::length,          Dimension::stress, Dimension::density,        Dimension::stiffness_gradient,
    Dimension::fracture_energy, Dimension::speed,  Dimension::speed_per_step, Dimension::time,
    Dimension::angle,           Dimension::force,  Dimension::energy,         Dimension::acceleration,
    Dimension::toughness};

std::optional<double> read(const std::string& text, Dimension dimension) {
    try {
        return parse_quantity(text, dimension);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

// Whether both are the same quantity, bit for bit.
bool same_quantity(const std::string& a, const std::string& b) {
    for (const Dimension dimension : dimensions)
        if (const std::optional<double> value = read(a, dimension)) return value == read(b, dimension);
    return false;
}

void collect(const toml::node& node, const std::string& key, std::vector<WrittenText>& texts) {
    if (const toml::table* table = node.as_table()) {
        for (const auto& [inner, value] : *table) collect(value, std::string(inner.str()), texts);
    } else if (const toml::array* list = node.as_array()) {
        for (const toml::node& value : *list) collect(value, key, texts);
    } else if (const auto* text = node.as_string()) {
        const std::string& given = text->get();
        if (given.find_first_of("\"\\\n") == std::string::npos && given.find_first_of("0123456789") != std::string::npos)
            texts.push_back({key, given});
    }
}

}  // namespace

std::vector<WrittenText> texts_of(const toml::table& tree) {
    std::vector<WrittenText> texts;
    collect(tree, {}, texts);
    return texts;
}

std::string resolved_toml_in_given_units(const Job& job) {
    const std::string plain = resolved_toml(job);
    static const std::regex token(R"(([A-Za-z0-9_-]+) = |"((?:[^"\\]|\\.)*)\")");
    std::string text = "# A job of Feldspar, format " + std::to_string(job_format) + ", with every default written out.\n", key;
    std::size_t copied = 0;
    for (std::sregex_iterator at(plain.begin(), plain.end(), token), end; at != end; ++at) {
        if ((*at)[1].matched) {
            key = (*at)[1];
            continue;
        }
        const std::string value = (*at)[2];
        for (const WrittenText& written : job.written) {
            if (written.key != key || written.text == value || !same_quantity(value, written.text)) continue;
            const auto from = static_cast<std::size_t>(at->position(2));
            text += plain.substr(copied, from - copied) + written.text;
            copied = from + value.size();
            break;
        }
    }
    return text + plain.substr(copied);
}

}  // namespace feldspar
