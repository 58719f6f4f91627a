// All mistakes of a file at once: they are collected while the file is read, so that the user mends them in one go.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"

namespace feldspar {

/// Several mistakes. As an InputError it is the first of them; what() tells of all, one after the other, or of the first 20 and
/// how many more.
class InputErrors : public InputError {
public:
    /// @param all  two or more, in the order in which they are told
    explicit InputErrors(std::vector<InputError> all);

    const std::vector<InputError>& all() const { return all_; }
    const char* what() const noexcept override { return text_.c_str(); }

    static constexpr std::size_t most_told = 20;
    static constexpr std::size_t most_kept = 1000;  ///< with so many reading ends: a file of another kind has one in every line

private:
    std::vector<InputError> all_;
    std::string text_;
};

/// The single mistakes of an error.
std::vector<InputError> each_mistake(const InputError& error);

/// The mistakes of one file, and of files that it names, as they are found; and which keys are therefore not to be relied on.
class Mistakes {
public:
    /// @param file  whose mistakes are told first
    explicit Mistakes(std::string file) : file_(std::move(file)) {}

    /// Takes an error, which may be of several mistakes. What is known already is not taken again.
    /// @param spoils  dotted key whose value is not known because of it; empty for none
    /// @throws InputErrors of all, if there are InputErrors::most_kept
    void add(const InputError& error, const std::string& spoils);

    /// The value of this key is not known, which needs no message of its own.
    void spoil(const std::string& key) { spoilt_.insert(key); }

    /// Neither the key, nor a table that it is in, nor anything in it is spoilt.
    bool sound(std::string_view key) const;

    bool none() const { return found_.empty(); }

    /// @throws InputError if there is one mistake, InputErrors if there are several: file by file, each in the order of lines
    void throw_if_any() const;

private:
    std::string file_;
    std::vector<InputError> found_;
    std::set<std::string, std::less<>> spoilt_;
};

}  // namespace feldspar
