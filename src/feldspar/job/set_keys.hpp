// Single keys of a job that stand elsewhere than in its file: on the command line.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "feldspar/job/toml_reader.hpp"

namespace feldspar {

/// Lays keys over a job. Each of `settings` is "key=value": a dotted key ("material.contact.tau"), and a value as the file would
/// have it. Text needs no quotes: what is no value of TOML is text ("30 MPa", "rigid").
///
/// `test.plate_mu` is for every [[test]], `test.brazilian.plate_Kn` for those of that kind, whose short name (BTS) is taken, too;
/// `variant.numerics.accuracy` for every [[variant]], `variant.rigid.numerics.accuracy` for the one of that name (in quotes if it
/// has a dot or a blank). Tables that are missing are made. Later settings go before earlier ones. What the reader says of such a
/// value or key names the setting instead of a line of the file.
/// @throws InputError for a setting without a key or '=', a value that cannot be read, a test or variant that the job has not, or
/// a key in what is no table
void set_keys(toml::table& job, std::span<const std::string> settings);

/// Whether a place in the source of a node is a setting, and not a line of a file.
bool is_setting(const toml::source_region& region);
/// The same of the place of a mistake.
bool is_setting(const InputPlace& place);

/// The key of a setting, word by word: {"test", "BTS", "plate_mu"}. @throws InputError as set_keys()
std::vector<std::string> key_of(const std::string& setting);

/// What stands for a setting as the file of a mistake: "--set 'material.contact.tau=1 GPa'".
std::string place_of(const std::string& setting);

/// The text of a file with the settings below it, as comments: for those who read later what was run.
std::string with_settings(const std::string& text, std::span<const std::string> settings);

}  // namespace feldspar
