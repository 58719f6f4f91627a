// The keys of a job file, each once: its table, what stands behind it, default, meaning, and where it applies.
//
// What speaks of keys comes out of these rows: readers take names, ranges and defaults from them (job_table.hpp),
// job-resolved.toml its units, templates their commented defaults, docs/job.md its tables (key_reference.hpp), and editors a
// schema (schema.hpp).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/range.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {

/// What one value is.
enum class ValueForm {
    quantity,  ///< text: a number with its unit
    number,    ///< a plain number
    fraction,  ///< a plain number, or text with a percent sign
    integer,   ///< a whole number
    flag,      ///< true or false
    text,      ///< text that is not empty
    choice,    ///< one of the words
    table      ///< a table of keys
};

/// One value, or each of a list.
struct KeyElement {
    ValueForm form = ValueForm::text;
    Dimension dimension = Dimension::fraction;  ///< of a quantity
    Range range = any_value;                    ///< of numbers; of text the words alone
    std::vector<std::string> words{};  ///< of a choice: all; of others: words that may stand in place of a value, such as "auto"
    std::string_view table{};          ///< of a table: its path among job_tables()
};

enum class ValueShape { one, list, one_or_list, pairs, tables };

struct KeyValue {
    KeyElement element;
    ValueShape shape = ValueShape::one;
    std::optional<KeyElement> second{};  ///< of pairs
    std::string_view unit{};             ///< in which people read it; empty: the usual one of its dimension
};

enum class KeyNeed {
    none,
    where_it_applies,  ///< must be given then, if no preset or table beneath gives it
    always             ///< no table does without it
};

/// What holds for a job without the key.
struct KeyDefault {
    KeyNeed need = KeyNeed::none;
    std::optional<double> value{};  ///< SI; of numbers and flags
    std::string toml{};             ///< of other values, as it would be written
    std::string words{};            ///< what is no value: "must be given", "found by the program"

    bool is_value() const { return value.has_value() || !toml.empty(); }
};

/// A key applies where another one has one of these words.
struct KeyCondition {
    std::string_view key{};  ///< of the same table, or of another: "model.kind"; empty: it applies everywhere
    std::vector<std::string> words{};

    bool holds(std::string_view word) const;
};

/// One key.
struct JobKey {
    std::string_view name;
    KeyValue value;
    KeyDefault usual;
    std::string meaning;           ///< one sentence in Markdown, without the full stop; links count from docs/
    KeyCondition when{};           ///< where it applies
    bool of_plates = false;        ///< of [[test]]: only where plates load the specimen
    std::string_view elsewhere{};  ///< why it does not apply elsewhere, to be added to "does not apply to kind = ..."
    std::string applies{};         ///< in place of the condition: "of flexible grains"
    std::string_view same_as{};    ///< another name of this key
};

/// The keys of one table.
struct KeyTable {
    std::string_view path;     ///< "specimen.grains"; "" for the file itself. [variant.model] and the like are "model"
    std::string_view head;     ///< as it is written: "[specimen.grains]", "[[test]]"
    std::vector<JobKey> keys;  ///< in the order in which users are told
    std::string meaning{};     ///< that of the key behind which the table stands; empty for the file itself

    std::vector<std::string_view> names() const;
    /// The row of a key, which must exist.
    const JobKey& key(std::string_view name) const;
};

/// All tables, in the order of docs/job.md.
std::span<const KeyTable> job_tables();

/// The table of this path, which must exist.
const KeyTable& job_table(std::string_view path);

/// Short for job_table(path).key(name).
const JobKey& job_key(std::string_view path, std::string_view name);

/// A value as it is written in a file, in the unit in which people read it: "\"80 mm\"", 0.1, true.
std::string as_written(const KeyValue& value, double si);

/// What may stand behind a key, in words: "a length, greater than zero", "\"curved\", \"flat\"".
std::string allowed(const JobKey& key);

/// What holds without it: a value as it would be written ("\"80 mm\"", 0.1), or words.
std::string usual_text(const JobKey& key);

/// Where the key applies, in words that follow "only"; empty: everywhere.
std::string applies_text(const JobKey& key);

/// "kind = \"biaxial\", \"brazilian\"": the words under which the key applies; empty: everywhere.
std::string condition_text(const JobKey& key);

/// Markdown as plain text: code loses its marks, a link its target; a link in brackets goes as a whole.
std::string without_markup(std::string_view markdown);

}  // namespace feldspar
