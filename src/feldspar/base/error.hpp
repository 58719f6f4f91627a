// The errors that Feldspar knows. The library throws them; only the program prints them and chooses the exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace feldspar {

/// Exit codes of the program `feldspar` (documented in the README).
enum class ExitCode : int { success = 0, input = 2, numerical = 3, output = 4, interrupted = 130 };

/// Where in the user's input a mistake stands. `line` and `column` count from 1; 0 means that it has no place (a
/// command-line option, or a key that is missing altogether).
struct InputPlace {
    std::string file{};
    int line = 0;
    int column = 0;
    std::string key{};  ///< full dotted key, for example `material.contact.Kn`; empty for a syntax error
};

/// A mistake of the user's, found before anything runs: exit code 2, and no file has been written.
class InputError : public std::runtime_error {
public:
    /// @param place       file, line, column and key
    /// @param problem     what is wrong, with the value that was given ("'25 MPa/m' is a stiffness gradient, not a stress")
    /// @param allowed     what would be accepted ("a stress such as \"25 GPa\""); may be empty
    /// @param suggestion  what the user probably meant ("did you mean 'merge_length'?"); may be empty
    InputError(InputPlace place, std::string problem, std::string allowed = {}, std::string suggestion = {})
        : std::runtime_error(compose(place, problem, allowed, suggestion)),
          place_(std::move(place)),
          problem_(std::move(problem)),
          allowed_(std::move(allowed)),
          suggestion_(std::move(suggestion)) {}

    const InputPlace& place() const { return place_; }
    const std::string& problem() const { return problem_; }
    const std::string& allowed() const { return allowed_; }
    const std::string& suggestion() const { return suggestion_; }

private:
    static std::string compose(const InputPlace& place, const std::string& problem, const std::string& allowed,
                               const std::string& suggestion);

    InputPlace place_;
    std::string problem_;
    std::string allowed_;
    std::string suggestion_;
};

/// The computation went wrong (a force is not a number, relaxation did not converge): exit code 3.
class NumericalError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A result could not be written (disk full, directory gone): exit code 4; files already finished stay whole.
class OutputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The user interrupted the run (Ctrl-C): exit code 130; what was finished is kept.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted by the user") {}
};

}  // namespace feldspar
