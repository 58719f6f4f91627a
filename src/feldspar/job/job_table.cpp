#include "feldspar/job/job_table.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace feldspar {

std::pair<long long, long long> whole_numbers(const JobKey& key) {
    const Range& range = key.value.element.range;
    return {static_cast<long long>(range.low),
            std::isinf(range.high) ? std::numeric_limits<long long>::max() : static_cast<long long>(range.high)};
}

JobTable JobTable::table(std::string_view key) const {
    const KeyTable& inside = job_table(row(key).value.element.table);
    return {TableReader::table(key, inside.names()), inside};
}

std::vector<JobTable> JobTable::tables(std::string_view key, std::string_view what, int level) const {
    const KeyTable& inside = job_table(row(key).value.element.table);
    std::vector<JobTable> found;
    for (const TableReader& one : TableReader::tables(key, what, inside.names(), level)) found.emplace_back(one, inside);
    return found;
}

void JobTable::suit(std::string_view key, std::string_view word, int decided_at) const {
    std::vector<std::string_view> needed;
    const std::string setting = std::string(key.substr(key.rfind('.') + 1)) + " = \"" + std::string(word) + "\"";
    for (const JobKey& one : rows_->keys) {
        if (one.when.key == key && !one.when.holds(word)) {
            if (!word.empty())
                refuse({one.name}, setting + std::string(one.elsewhere), "only with " + condition_text(one), decided_at);
        } else if (one.usual.need != KeyNeed::none) {
            needed.push_back(one.name);
        }
    }
    require(needed);
}

double JobTable::quantity(std::string_view key, std::optional<double> otherwise) const {
    const JobKey& known = row(key);
    return TableReader::quantity(key, known.value.element.dimension, known.value.element.range,
                                 otherwise ? otherwise : known.usual.value);
}

double JobTable::quantity_as(std::string_view key, Dimension dimension) const {
    return TableReader::quantity(key, dimension, row(key).value.element.range);
}

double JobTable::number(std::string_view key, std::optional<double> otherwise) const {
    const JobKey& known = row(key);
    return TableReader::number(key, known.value.element.range, otherwise ? otherwise : known.usual.value);
}

double JobTable::fraction(std::string_view key) const {
    return TableReader::fraction(key, row(key).value.element.range, row(key).usual.value);
}

long long JobTable::integer(std::string_view key) const {
    const JobKey& known = row(key);
    const auto [low, high] = whole_numbers(known);
    std::optional<long long> usual;
    if (known.usual.value) usual = static_cast<long long>(*known.usual.value);
    return TableReader::integer(key, low, high, usual);
}

bool JobTable::flag(std::string_view key) const { return TableReader::flag(key, row(key).usual.value.value_or(0.0) != 0.0); }

Vec2 JobTable::point(std::string_view key) const {
    const toml::array& pair = array(key);
    Vec2 point;
    check({key}, [&] { point = point_of(pair, key); });
    return point;
}

Vec2 JobTable::point_of(const toml::node& node, std::string_view key) const {
    const toml::array* pair = node.as_array();
    if (pair == nullptr || pair->size() != 2)
        fail_at(node, key, shown(node) + " is not a point", "a point such as [\"40 mm\", \"80 mm\"]");
    return {quantity_of(*pair->get(0), key), quantity_of(*pair->get(1), key)};
}

double JobTable::quantity_of(const toml::node& node, std::string_view key) const {
    return element_of(node, key, row(key).value.element);
}

double JobTable::element_of(const toml::node& node, std::string_view key, const KeyElement& element) const {
    if (element.form == ValueForm::fraction) return TableReader::fraction_of(node, key, element.range);
    return TableReader::quantity_of(node, key, element.dimension, element.range);
}

}  // namespace feldspar
