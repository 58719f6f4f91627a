// A checked view of one table of a job file: every key known, every value converted and bounded, and every complaint with
// file, line, column, key, what was given and what is allowed. Tables may lie over each other: a key is then looked for in the
// upper ones first, and a complaint points to the table that gave it.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/range.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/job/mistakes.hpp"
#include "feldspar/job/toml_include.hpp"

namespace feldspar {

/// The candidate that `word` was probably meant to be (optimal string alignment distance, case ignored), or "" when none is near.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "did you mean 'candidate'?" or "".
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// "a, b, c".
std::string listed(std::span<const std::string_view> words);

/// The level of a key that nobody gave: below every table.
inline constexpr int not_given = std::numeric_limits<int>::max();

/// One table, with the names that may stand in it.
///
/// With a list of mistakes reading goes on after one: it is noted, and its key takes its fallback, or a value that stands in
/// (not-a-number, "", the first of the choices, the lowest whole number, an empty list or table). What rests on such a key is to
/// be asked for by check() or after sound(), else one mistake would cause messages that only follow from it. Whoever made the
/// list throws at the end, so no such value is ever used. Without a list the first mistake is thrown.
class TableReader {
public:
    /// @param path   dotted path of the table, "" for the file itself
    /// @param known  all keys that may stand in it. Any other is a mistake, with "did you mean"; the key that was meant counts as
    /// spoilt
    /// @param level  among tables that lie over each other: a smaller one goes before a larger one
    /// @param mistakes  takes those of this table and of all tables in it; must outlive them
    TableReader(const toml::table& table, std::string path, std::string file, std::span<const std::string_view> known,
                int level = 0, Mistakes* mistakes = nullptr);
    TableReader(const toml::table& table, std::string path, std::string file, std::initializer_list<std::string_view> known,
                int level = 0, Mistakes* mistakes = nullptr)
        : TableReader(table, std::move(path), std::move(file), std::span(known.begin(), known.size()), level, mistakes) {}

    /// This table, which stands elsewhere (a preset), as if it were written at `place`, where it is named.
    TableReader placed_at(const toml::node& place) const;

    /// This table laid over another: keys that it does not give are looked for there.
    TableReader over(const TableReader& under) const;

    bool has(std::string_view key) const { return find(key) != nullptr; }
    const toml::node* find(std::string_view key) const { return owner(key).table_->get(key); }
    /// The level of the table that gives the key, or `not_given`.
    int level_of(std::string_view key) const { return has(key) ? owner(key).level_ : not_given; }
    int level() const { return level_; }
    const std::string& file() const { return file_; }
    /// Line of the table's head.
    int line() const { return static_cast<int>(region_of(*table_).begin.line); }

    /// These keys, and all that is in them, were read without a mistake.
    bool sound(std::initializer_list<std::string_view> keys) const {
        return std::all_of(keys.begin(), keys.end(), [&](std::string_view key) { return is_sound(key); });
    }
    /// Does what may fail(), if `keys` are sound: a mistake in it is noted, and reading goes on behind it.
    template <class Action>
    void check(std::initializer_list<std::string_view> keys, Action&& action) const {
        if (mistakes_ == nullptr) return action();
        if (!sound(keys)) return;
        try {
            action();
        } catch (const InputError& error) {
            const bool here = error.place().file == file_;
            mistakes_->add(error, here ? error.place().key : keys.size() == 0 ? std::string() : full(*keys.begin()));
        }
    }
    /// Of these keys, those that are not there are not missed: they may be in what could not be read.
    void do_not_miss(std::span<const std::string_view> keys) const;
    void do_not_miss(std::initializer_list<std::string_view> keys) const { do_not_miss(std::span(keys.begin(), keys.size())); }
    /// Where mistakes go, or nothing.
    Mistakes* mistakes() const { return mistakes_; }

    /// Every one of `keys` must be there: a mistake that names those that are missing.
    void require(std::span<const std::string_view> keys) const;
    void require(std::initializer_list<std::string_view> keys) const { require(std::span(keys.begin(), keys.size())); }
    /// A mistake for each of `keys` that is given; `setting` is what it contradicts ("shape = \"disc\""). A key from a table
    /// below the one that made the setting (`decided_at`) is not a mistake: the setting has put it aside.
    void refuse(std::initializer_list<std::string_view> keys, const std::string& setting, const std::string& allowed = {},
                int decided_at = not_given) const;

    /// A table inside this one, which must be there; without any key if it is not and mistakes are collected.
    TableReader table(std::string_view key, std::span<const std::string_view> known) const;
    TableReader table(std::string_view key, std::initializer_list<std::string_view> known) const {
        return table(key, std::span(known.begin(), known.size()));
    }

    /// The tables of the list [[key]], which must hold one at least, in order. @param what  one of them in words, "a test"
    std::vector<TableReader> tables(std::string_view key, std::string_view what, std::span<const std::string_view> known,
                                    int level = 0) const;
    std::vector<TableReader> tables(std::string_view key, std::string_view what, std::initializer_list<std::string_view> known,
                                    int level = 0) const {
        return tables(key, what, std::span(known.begin(), known.size()), level);
    }

    /// Text with a unit, in SI. Without a fallback the key must be there.
    double quantity(std::string_view key, Dimension dimension, const Range& range, std::optional<double> fallback = {}) const;
    /// A plain number.
    double number(std::string_view key, const Range& range, std::optional<double> fallback = {}) const;
    /// A number, or a percentage as text.
    double fraction(std::string_view key, const Range& range, std::optional<double> fallback = {}) const;
    long long integer(std::string_view key, long long low, long long high, std::optional<long long> fallback = {}) const;
    bool flag(std::string_view key, bool fallback) const;
    /// Text that is not empty.
    std::string text(std::string_view key, std::optional<std::string> fallback = {}) const;
    const toml::array& array(std::string_view key) const;

    /// One of several words.
    template <class Value>
    Value choice(std::string_view key, std::initializer_list<std::pair<std::string_view, Value>> choices,
                 std::optional<Value> fallback = {}) const {
        return choice_among<Value>(key, std::span(choices.begin(), choices.size()), fallback);
    }
    /// One of several values, by the names that name(value) gives them.
    template <std::ranges::range Values, class Value = std::ranges::range_value_t<Values>>
    Value choice(std::string_view key, const Values& values, std::optional<Value> fallback = {}) const {
        std::vector<std::pair<std::string_view, Value>> choices;
        for (const Value value : values) choices.emplace_back(name(value), value);
        return choice_among<Value>(key, choices, fallback);
    }

    /// The same readings for a value that stands in a list; `key` is what messages call it. @throws InputError also if mistakes
    /// are collected (see check()).
    double quantity_of(const toml::node& node, std::string_view key, Dimension dimension, const Range& range) const;
    double fraction_of(const toml::node& node, std::string_view key, const Range& range) const;
    long long integer_of(const toml::node& node, std::string_view key, long long low, long long high) const;
    std::string text_of(const toml::node& node, std::string_view key) const;

    /// Complains about `key`, at its value if it has one, else at the head of the table.
    [[noreturn]] void fail(std::string_view key, const std::string& problem, const std::string& allowed = {},
                           const std::string& suggestion = {}) const;
    /// Complains about a value inside a list.
    [[noreturn]] void fail_at(const toml::node& node, std::string_view key, const std::string& problem,
                              const std::string& allowed = {}, const std::string& suggestion = {}) const;

private:
    template <class Value>
    Value choice_among(std::string_view key, std::span<const std::pair<std::string_view, Value>> choices,
                       std::optional<Value> fallback) const {
        if (!has(key) && fallback) return *fallback;
        return noted(key, fallback.value_or(choices.front().second), [&] {
            const std::string given = text_of(must_have(key), key);
            std::vector<std::string_view> words;
            for (const auto& [word, value] : choices) {
                if (word == given) return value;
                words.push_back(word);
            }
            fail(key, "'" + given + "' is not one of the choices", listed(words), did_you_mean(given, words));
        });
    }
    // What `read` gives; after a mistake, which is noted, or for a key that is known to be spoilt and missing, what stands in.
    template <class Value, class Read>
    Value noted(std::string_view key, Value stand_in, Read&& read) const {
        if (mistakes_ == nullptr) return read();
        if (!has(key) && !is_sound(key)) return stand_in;
        try {
            return read();
        } catch (const InputError& error) {
            mistakes_->add(error, full(key));
            return stand_in;
        }
    }
    bool is_sound(std::string_view key) const;
    InputError missing(std::span<const std::string_view> keys) const;
    const TableReader& owner(std::string_view key) const;  // the table that gives the key, or this one
    std::string full(std::string_view key) const;
    const toml::node& must_have(std::string_view key) const;
    const toml::source_region& region_of(const toml::node& node) const { return stands_in_ ? *stands_in_ : node.source(); }

    const toml::table* table_;
    std::string path_;
    std::string file_;
    int level_ = 0;
    Mistakes* mistakes_ = nullptr;
    std::optional<toml::source_region> stands_in_;  // of a table that is placed elsewhere
    std::shared_ptr<const TableReader> under_;
};

/// The text of a file that a user has written. @param what  "job", "study"; @param suggestion  for a file that is not there
/// @throws InputError if it cannot be read, or is larger than any such file
std::string read_toml_file(const std::filesystem::path& file, const std::string& what, const std::string& suggestion = {});

/// Where a character beyond ASCII stands outside of quotes and comments, which TOML does not allow, or behind a backslash; its
/// place in the text. The library would go on with undefined behaviour there.
std::optional<std::size_t> beyond_ascii_outside_quotes(std::string_view text);

/// Parses TOML. @throws InputError at the place of a syntax error.
toml::table parse_toml(const std::string& text, const std::string& file);

/// The value as the user wrote it, for messages: 'text', 12, "a table", ...
std::string shown(const toml::node& node);

}  // namespace feldspar
