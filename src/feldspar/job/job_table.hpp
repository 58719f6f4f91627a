// A table of a job file, read by its rows (keys.hpp): they say which keys there are, what each may be, and what holds without it.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "feldspar/base/vec2.hpp"
#include "feldspar/job/keys.hpp"
#include "feldspar/job/toml_reader.hpp"

namespace feldspar {

/// Everything that a TableReader does, for tables that have rows. The readings without a range take that of the row; a key that
/// is not there has the row's default, or must be given if there is none. A default that depends on other keys is given as
/// `otherwise`.
class JobTable : public TableReader {
public:
    /// @param table  read with the names of `rows` as known keys
    JobTable(TableReader table, const KeyTable& rows) : TableReader(std::move(table)), rows_(&rows) {}

    const KeyTable& rows() const { return *rows_; }

    /// A table inside this one.
    JobTable table(std::string_view key) const;
    /// The tables of a list. @param what  one of them in words, "a test"
    std::vector<JobTable> tables(std::string_view key, std::string_view what, int level = 0) const;
    JobTable over(const JobTable& under) const { return {TableReader::over(under), *rows_}; }

    double quantity(std::string_view key, std::optional<double> otherwise = {}) const;
    /// A quantity whose dimension another key decides.
    double quantity_as(std::string_view key, Dimension dimension) const;
    double number(std::string_view key, std::optional<double> otherwise = {}) const;
    double fraction(std::string_view key) const;
    long long integer(std::string_view key) const;
    bool flag(std::string_view key) const;
    /// One of the row's words, which are the names of `values`.
    template <std::ranges::range Values>
    std::ranges::range_value_t<Values> choice(std::string_view key, const Values& values) const {
        return TableReader::choice(key, values, usual(key, values));
    }

    /// x and y of a point.
    Vec2 point(std::string_view key) const;
    /// The same for a point that stands in a list. @throws InputError also if mistakes are collected (see check())
    Vec2 point_of(const toml::node& node, std::string_view key) const;

    /// Values in a list. @throws InputError also if mistakes are collected (see check())
    double quantity_of(const toml::node& node, std::string_view key) const;
    /// A list of pairs. Calls `take(first, second)` with the nodes of each, as check() does. @param what  one of them in words,
    /// "a point"
    /// @param allowed  what pairs look like
    template <class Take>
    void pairs(std::string_view key, std::string_view what, const std::string& allowed, Take&& take) const {
        for (const toml::node& node : array(key))
            check({}, [&] {
                const toml::array* pair = node.as_array();
                if (pair == nullptr || pair->size() != 2)
                    fail_at(node, key, shown(node) + " is not " + std::string(what), allowed);
                take(*pair->get(0), *pair->get(1));
            });
    }
    /// The first and the second value of such a pair.
    double first_of(const toml::node& node, std::string_view key) const { return element_of(node, key, row(key).value.element); }
    double second_of(const toml::node& node, std::string_view key) const { return element_of(node, key, *row(key).value.second); }

    /// Where `key` has `word`: refuses keys that only apply under its other words, and requires those that must be given now. An
    /// empty word stands for one that is not known: then only what applies everywhere is required. @param decided_at  level of
    /// the table that gave the word (see refuse())
    void suit(std::string_view key, std::string_view word, int decided_at = not_given) const;

    /// What the key may be, in words.
    std::string allowed(std::string_view key) const { return feldspar::allowed(row(key)); }

private:
    const JobKey& row(std::string_view key) const { return rows_->key(key); }
    double element_of(const toml::node& node, std::string_view key, const KeyElement& element) const;
    template <std::ranges::range Values>
    std::optional<std::ranges::range_value_t<Values>> usual(std::string_view key, const Values& values) const {
        for (const auto value : values)
            if (row(key).usual.toml == "\"" + std::string(name(value)) + "\"") return value;
        return std::nullopt;
    }

    const KeyTable* rows_;
};

/// The lowest and the highest whole number of a row.
std::pair<long long, long long> whole_numbers(const JobKey& key);

}  // namespace feldspar
