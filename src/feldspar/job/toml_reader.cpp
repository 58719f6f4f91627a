#define TOML_IMPLEMENTATION
#include "feldspar/job/toml_reader.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "feldspar/job/set_keys.hpp"

namespace feldspar {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();  // stands in for a number that could not be read
constexpr std::size_t largest_file = 16u << 20;  // bytes; what a user writes is a page, so anything beyond is a mistaken file

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// "axis[2].value" -> "axis.value", as in the head of a table.
std::string without_numbers(const std::string& path) {
    std::string head;
    bool number = false;
    for (const char c : path) {
        if (c == '[') number = true;
        if (!number) head += c;
        if (c == ']') number = false;
    }
    return head;
}

// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours count one each.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
            const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

std::string type_words(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (node.is_array()) return "a list";
    if (node.is_string()) return "text";
    if (node.is_boolean()) return "true or false";
    if (node.is_number()) return "a number";
    return "a date or time";
}

InputPlace place_of(const toml::source_region& region, const std::string& file, std::string key) {
    if (is_setting(region)) return {*region.path, 0, 0, std::move(key)};
    return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), std::move(key)};
}

std::string bounded(const Range& range, std::string_view kind) { return std::string(kind) + ", " + std::string(range.words); }

}  // namespace

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
    if (word.size() > 64) return {};
    std::string_view best;
    std::size_t best_distance =
        word.size() <= 3 ? 2 : 1 + std::max<std::size_t>(2, word.size() / 3);  // first distance that is too far
    for (std::string_view candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance && distance < candidate.size()) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::string_view best = nearest(word, candidates);
    return best.empty() ? std::string() : "did you mean '" + std::string(best) + "'?";
}

std::string listed(std::span<const std::string_view> words) {
    std::string text;
    for (std::string_view word : words) {
        if (!text.empty()) text += ", ";
        text += word;
    }
    return text;
}

std::string shown(const toml::node& node) {
    if (const auto* text = node.as_string()) return "'" + text->get() + "'";
    if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
    if (const auto* real = node.as_floating_point()) return format_exact(real->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    return type_words(node);
}

std::string read_toml_file(const std::filesystem::path& file, const std::string& what, const std::string& suggestion) {
    const InputPlace place{file.string(), 0, 0, {}};
    if (file.empty()) throw InputError({}, "no " + what + " file is named");
    std::error_code error;
    if (std::filesystem::is_directory(file, error)) throw InputError(place, "is a directory, not a " + what + " file");
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InputError(place, std::string("cannot be read: ") + (errno != 0 ? std::strerror(errno) : "unknown reason"), {},
                         suggestion);
    std::string text(largest_file + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (stream.bad()) throw InputError(place, "cannot be read to its end");
    if (text.size() > largest_file) throw InputError(place, "is larger than 16 MiB, which no " + what + " is");
    return text;
}

std::optional<std::size_t> beyond_ascii_outside_quotes(std::string_view text) {
    // Quotes begin a text only where a key or a value begins: in 99'x' the library reads on as if there were none.
    std::string brackets;  // that are open, outside of a table's head
    bool key = true;       // or a value
    char before = '\n';
    for (std::size_t i = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < text.size(); before = text[i++]) {
        const char c = text[i];
        if (static_cast<unsigned char>(c) >= 0x80) return i;
        if (c == '#') i = std::min(text.find('\n', i), text.size() - 1);
        const bool begins = std::string_view(" \t\r\n=,[{").find(before) != std::string_view::npos || (before == '.' && key);
        if ((c == '"' || c == '\'') && begins) {
            const bool escapes = c == '"', many_lines = text.substr(i).starts_with(std::string(3, c));
            const std::string_view end = text.substr(i, many_lines ? 3 : 1);
            for (i += end.size(); i < text.size() && !text.substr(i).starts_with(end); ++i) {
                if (text[i] == '\n' && !many_lines) break;  // the quote is missing, which the library will say
                if (text[i] != '\\' || !escapes) continue;
                // behind a backslash, and a line end there, the library asks of what follows whether it is a space
                const std::size_t next = many_lines ? text.find_first_not_of(" \t\r\n", i + 1) : i + 1;
                if (next < text.size() && static_cast<unsigned char>(text[next]) >= 0x80) return next;
                ++i;
            }
            i = std::min(i + end.size(), text.size()) - 1;
        }
        if (text[i] == '\n' && brackets.empty()) key = true;
        if (c == '=') key = false;
        if (c == '{' || (c == '[' && !key)) brackets += c;
        if ((c == ']' || c == '}') && !brackets.empty()) brackets.pop_back();
        if (c == '{' || c == ',') key = brackets.ends_with('{');
    }
    return std::nullopt;
}

toml::table parse_toml(const std::string& text, const std::string& file) {
    if (const auto strange = beyond_ascii_outside_quotes(text)) {
        const std::string_view before = std::string_view(text).substr(0, *strange);
        const auto line_begin = before.rfind('\n') + 1;  // npos + 1 = 0
        std::size_t end = *strange + 1;
        while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
        const InputPlace place{
            file, static_cast<int>(std::ranges::count(before, '\n')) + 1, static_cast<int>(*strange - line_begin) + 1, {}};
        throw InputError(
            place,
            "syntax error: '" + text.substr(*strange, end - *strange) + "' stands outside of quotes, or behind a backslash",
            "letters, digits, '-' and '_' in keys, and values with other characters in quotes");
    }
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw InputError(place_of(error.source(), file, {}), "syntax error: " + std::string(error.description()));
    }
}

TableReader::TableReader(const toml::table& table, std::string path, std::string file, std::span<const std::string_view> known,
                         int level, Mistakes* mistakes)
    : table_(&table), path_(std::move(path)), file_(std::move(file)), level_(level), mistakes_(mistakes) {
    std::vector<const toml::key*> unknown;
    for (const auto& [key, value] : table)
        if (std::find(known.begin(), known.end(), key.str()) == known.end()) unknown.push_back(&key);
    // in the order of the file, not of the alphabet
    std::sort(unknown.begin(), unknown.end(),
              [](const toml::key* a, const toml::key* b) { return a->source().begin < b->source().begin; });
    if (unknown.empty()) return;
    std::vector<std::string_view> likely(known.begin(),
                                         known.end());  // of equally near ones the key that is not there yet was meant
    std::stable_partition(likely.begin(), likely.end(), [&](std::string_view key) { return !table.contains(key); });
    for (const toml::key* key : unknown) {
        const InputError error(place_of(key->source(), file_, full(key->str())), "unknown key", listed(known),
                               did_you_mean(key->str(), likely));
        if (mistakes_ == nullptr) throw error;
        const std::string_view meant = nearest(key->str(), likely);
        // a table may be there in part, under its right name
        const bool missed =
            !meant.empty() && (!has(meant) || table.get(key->str())->is_table() || table.get(key->str())->is_array_of_tables());
        mistakes_->add(error, missed ? full(meant) : std::string());
    }
}

TableReader TableReader::placed_at(const toml::node& place) const {
    TableReader result = *this;
    result.stands_in_ = place.source();
    return result;
}

TableReader TableReader::over(const TableReader& under) const {
    TableReader result = *this;
    result.under_ = std::make_shared<const TableReader>(under_ ? under_->over(under) : under);
    return result;
}

const TableReader& TableReader::owner(std::string_view key) const {
    for (const TableReader* reader = this; reader != nullptr; reader = reader->under_.get())
        if (reader->table_->contains(key)) return *reader;
    return *this;
}

std::string TableReader::full(std::string_view key) const {
    const std::string& path = owner(key).path_;
    return path.empty() ? std::string(key) : path + "." + std::string(key);
}

bool TableReader::is_sound(std::string_view key) const {
    if (mistakes_ == nullptr) return true;
    if (has(key)) return mistakes_->sound(full(key));
    for (const TableReader* reader = this; reader != nullptr; reader = reader->under_.get())
        if (!mistakes_->sound(reader->path_.empty() ? std::string(key) : reader->path_ + "." + std::string(key))) return false;
    return true;
}

void TableReader::do_not_miss(std::span<const std::string_view> keys) const {
    for (const std::string_view key : keys)
        if (mistakes_ != nullptr && !has(key)) mistakes_->spoil(full(key));
}

InputError TableReader::missing(std::span<const std::string_view> keys) const {
    InputPlace place = path_.empty() ? InputPlace{file_, 0, 0, {}} : place_of(region_of(*table_), file_, path_);
    return InputError(std::move(place), (keys.size() == 1 ? "missing key: " : "missing keys: ") + listed(keys));
}

void TableReader::require(std::span<const std::string_view> keys) const {
    std::vector<std::string_view> absent;
    for (std::string_view key : keys)
        if (!has(key) && is_sound(key)) absent.push_back(key);
    if (absent.empty()) return;
    const InputError error = missing(absent);
    if (mistakes_ == nullptr) throw error;
    mistakes_->add(error, {});
    do_not_miss(absent);
}

void TableReader::refuse(std::initializer_list<std::string_view> keys, const std::string& setting, const std::string& allowed,
                         int decided_at) const {
    for (std::string_view key : keys)
        if (has(key) && level_of(key) <= decided_at) check({}, [&] { fail(key, "does not apply to " + setting, allowed); });
}

const toml::node& TableReader::must_have(std::string_view key) const {
    if (!has(key)) throw missing(std::span(&key, 1));
    return *find(key);
}

TableReader TableReader::table(std::string_view key, std::span<const std::string_view> known) const {
    static const toml::table empty;
    const toml::table& found = *noted<const toml::table*>(key, &empty, [&] {
        const toml::node& node = must_have(key);
        if (!node.is_table()) fail(key, "is " + type_words(node) + ", not a table", "a table [" + full(key) + "]");
        return node.as_table();
    });
    TableReader inside(found, full(key), file_, known, owner(key).level_, mistakes_);
    inside.stands_in_ = owner(key).stands_in_;
    return inside;
}

std::vector<TableReader> TableReader::tables(std::string_view key, std::string_view what, std::span<const std::string_view> known,
                                             int level) const {
    const std::string head = "[[" + without_numbers(full(key)) + "]]";
    std::vector<TableReader> readers;
    if (has(key) && find(key)->is_table()) {
        check({key}, [&] { fail(key, "is written as one table", "a list of tables, each headed " + head); });
        return readers;
    }
    std::size_t number = 0;
    for (const toml::node& node : array(key)) {
        ++number;
        check({}, [&] {
            if (!node.is_table()) fail_at(node, key, shown(node) + " is not " + std::string(what), "a table headed " + head);
            readers.emplace_back(*node.as_table(), full(key) + "[" + std::to_string(number) + "]", file_, known, level,
                                 mistakes_);
        });
    }
    if (number == 0) check({key}, [&] { fail(key, "the list is empty", "one " + head + " or more"); });
    return readers;
}

const toml::array& TableReader::array(std::string_view key) const {
    static const toml::array empty;
    return *noted<const toml::array*>(key, &empty, [&] {
        const toml::node& node = must_have(key);
        if (!node.is_array()) fail(key, shown(node) + " is not a list", "a list in square brackets");
        return node.as_array();
    });
}

double TableReader::quantity_of(const toml::node& node, std::string_view key, Dimension dimension, const Range& range) const {
    const std::string wanted =
        std::string(describe(dimension)) + " with its unit, such as \"" + std::string(example(dimension)) + "\"";
    if (node.is_number()) fail_at(node, key, shown(node) + " has no unit", wanted);
    if (!node.is_string()) fail_at(node, key, shown(node) + " is not " + std::string(describe(dimension)), wanted);
    double value = 0.0;
    try {
        value = parse_quantity(node.as_string()->get(), dimension);
    } catch (const InputError& error) {
        fail_at(node, key, error.problem(), error.allowed(), error.suggestion());
    }
    if (!range.contains(value)) fail_at(node, key, shown(node) + " is not allowed", bounded(range, describe(dimension)));
    return value;
}

double TableReader::quantity(std::string_view key, Dimension dimension, const Range& range,
                             std::optional<double> fallback) const {
    if (!has(key) && fallback) return *fallback;
    return noted(key, fallback.value_or(nothing), [&] { return quantity_of(must_have(key), key, dimension, range); });
}

double TableReader::number(std::string_view key, const Range& range, std::optional<double> fallback) const {
    if (!has(key) && fallback) return *fallback;
    return noted(key, fallback.value_or(nothing), [&] {
        const toml::node& node = must_have(key);
        if (!node.is_number())
            fail(key, shown(node) + " is not a plain number", bounded(range, "a number without quotes or unit"));
        const double value = *node.value<double>();
        if (!std::isfinite(value)) fail(key, shown(node) + " is not a finite number", bounded(range, "a number"));
        if (!range.contains(value)) fail(key, shown(node) + " is not allowed", bounded(range, "a number"));
        return value;
    });
}

double TableReader::fraction_of(const toml::node& node, std::string_view key, const Range& range) const {
    double value = 0.0;
    if (node.is_number()) {
        value = *node.value<double>();
        if (!std::isfinite(value)) fail_at(node, key, shown(node) + " is not a finite number", bounded(range, "a fraction"));
    } else if (node.is_string()) {
        try {
            value = parse_quantity(node.as_string()->get(), Dimension::fraction);
        } catch (const InputError& error) {
            fail_at(node, key, error.problem(), error.allowed(), error.suggestion());
        }
    } else {
        fail_at(node, key, shown(node) + " is not a fraction", bounded(range, "a fraction"));
    }
    if (!range.contains(value)) fail_at(node, key, shown(node) + " is not allowed", bounded(range, "a fraction"));
    return value;
}

double TableReader::fraction(std::string_view key, const Range& range, std::optional<double> fallback) const {
    if (!has(key) && fallback) return *fallback;
    return noted(key, fallback.value_or(nothing), [&] { return fraction_of(must_have(key), key, range); });
}

long long TableReader::integer_of(const toml::node& node, std::string_view key, long long low, long long high) const {
    const std::string allowed = high == std::numeric_limits<long long>::max()
                                    ? "a whole number, " + std::to_string(low) + " or greater"
                                    : "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    if (!node.is_integer()) fail_at(node, key, shown(node) + " is not a whole number", allowed);
    const long long value = node.as_integer()->get();
    if (value < low || value > high) fail_at(node, key, shown(node) + " is not allowed", allowed);
    return value;
}

long long TableReader::integer(std::string_view key, long long low, long long high, std::optional<long long> fallback) const {
    if (!has(key) && fallback) return *fallback;
    return noted(key, fallback.value_or(low), [&] { return integer_of(must_have(key), key, low, high); });
}

bool TableReader::flag(std::string_view key, bool fallback) const {
    if (!has(key)) return fallback;
    return noted(key, fallback, [&] {
        const toml::node& node = *find(key);
        if (!node.is_boolean()) fail(key, shown(node) + " is neither true nor false", "true, false (without quotes)");
        return node.as_boolean()->get();
    });
}

std::string TableReader::text_of(const toml::node& node, std::string_view key) const {
    if (!node.is_string()) fail_at(node, key, shown(node) + " is not text", "text in quotes");
    const std::string& value = node.as_string()->get();
    if (value.empty()) fail_at(node, key, "the text is empty");
    return value;
}

std::string TableReader::text(std::string_view key, std::optional<std::string> fallback) const {
    if (!has(key) && fallback) return *fallback;
    return noted(key, fallback.value_or(std::string()), [&] { return text_of(must_have(key), key); });
}

void TableReader::fail(std::string_view key, const std::string& problem, const std::string& allowed,
                       const std::string& suggestion) const {
    const toml::node* node = find(key);
    const toml::source_region& where = node != nullptr ? owner(key).region_of(*node) : region_of(*table_);
    throw InputError(place_of(where, file_, full(key)), problem, allowed, suggestion);
}

void TableReader::fail_at(const toml::node& node, std::string_view key, const std::string& problem, const std::string& allowed,
                          const std::string& suggestion) const {
    throw InputError(place_of(owner(key).region_of(node), file_, full(key)), problem, allowed, suggestion);
}

}  // namespace feldspar
