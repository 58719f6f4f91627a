// A job over which pieces are laid: single keys or whole tables of another job.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "feldspar/job/toml_reader.hpp"
#include "feldspar/study/study.hpp"

namespace feldspar {

/// The tables of a job that a piece may hold.
inline constexpr std::array<std::string_view, 5> job_pieces{"specimen", "model", "material", "numerics", "test"};

/// A number and what follows it: 66.1 and " N/m"; nothing follows a plain number. Of a word the number is not-a-number.
struct Measure {
    double number = 0.0;
    std::string unit;
};

Measure measure_of(const toml::node& node);

/// What a value of an axis is called: a word as it stands, a number in short ("0.2").
std::string axis_label(const toml::node& node);

/// Puts a value where a dotted key ("material.contact.tau") says, making tables on the way.
void insert(toml::table& piece, const std::string& key, const toml::node& value);
void insert(toml::table& piece, const std::string& key, const Measure& measure);

/// Lays a table over another, key by key. A grain size distribution replaces another as a whole.
void lay_over(toml::table& under, const toml::table& over);

/// The piece of a job that a key holds, which must be a table of job_pieces; what is in it is judged with the whole job
toml::table read_piece(const TableReader& table, std::string_view key);

/// The dotted key, which must be of a job's pieces. @param key  of the table, for messages
std::string read_job_key(const TableReader& table, std::string_view key, const std::string& dotted);

/// `coupled` of a table, such as { material.contact.Gfs = 31.5 }: dotted keys and the factors by which they follow another one.
std::vector<std::pair<std::string, double>> read_coupled(const TableReader& table);

/// The name that a key gives to a directory of results, which lies under results/ and nowhere else.
/// @param fallback  if the key is missing. It must be up to 100 letters, digits, '-', '_' and '.', not beginning with '.'
std::string read_directory_name(const TableReader& table, std::string_view key, const std::string& fallback);

/// The job that a file names by `job`, with the file's `[set]`, if there is one, laid over it. In a piece `test.plate_mu` is for
/// every test, `test.brazilian.plate_Kn` for those of that kind. [specimen] and [[test]] are changed in place; [model],
/// [material] and [numerics] are given as a variant, so that what goes before what is decided in one place
/// (job/read_physics.cpp).
class BaseJob {
public:
    /// Reads the keys `job` and `set` of a file; a relative path counts from that file's folder. Mistakes in the job are noted as
    /// such of `job`.
    /// @param settings  "key=value", as set_keys() takes them: laid over the job, `[set]` and every piece. Those of `variant` and
    /// `laboratory` are laid over the job's own file  @throws InputError for one of another table than these and job_pieces
    BaseJob(const TableReader& root, const std::filesystem::path& file, std::span<const std::string> settings = {});

    /// As the job's own file has it.
    const Job& job() const { return job_; }
    const toml::table& tree() const { return tree_; }

    /// The job with `[set]` and a piece laid over it; with a single variant without a name. @throws InputError
    Job with(const toml::table& piece) const;

    /// The setting behind which a key of a piece would be lost, in part or as a whole; none if there is none.
    std::optional<std::string> setting_over(const std::string& key) const;
    /// The same for all keys of a piece.
    std::optional<std::string> setting_over(const toml::table& piece) const;

    /// What a key has in the resolved job with this piece, presets and defaults included. @throws InputError unless it is a
    /// number
    Measure value_in(const toml::table& piece, const std::string& key) const;

private:
    toml::table tree_;
    std::string text_;
    std::filesystem::path file_;
    Job job_;
    toml::table common_;                         // [set]
    std::vector<std::string> physics_, others_;  // settings of pieces: of tables that variants have, and of the rest
};

}  // namespace feldspar
