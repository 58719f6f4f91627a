// Runs the program `feldspar` as a user would, in a directory of its own.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../temporary_folder.hpp"

namespace feldspar::testing_program {

namespace fs = std::filesystem;

struct Outcome {
    int code = -1;  ///< exit code; 128 + signal when a signal ended it
    std::string out;
    std::string err;
    double resident_bytes = 0.0;  ///< at most
};

/// A running program. Its output goes to files outside its working directory.
class Program {
public:
    /// @param in_child  called in the child before the program starts (limits)
    Program(const fs::path& directory, std::vector<std::string> arguments, const std::function<void()>& in_child = {}) {
        const fs::path out = outputs_ / "out", err = outputs_ / "err";
        std::vector<char*> argv{const_cast<char*>(FELDSPAR_PROGRAM)};
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        child_ = fork();
        if (child_ < 0) throw std::runtime_error("cannot fork");
        if (child_ > 0) return;
        const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out_file, STDOUT_FILENO);
        dup2(err_file, STDERR_FILENO);
        if (chdir(directory.c_str()) != 0) _exit(126);
        if (in_child) in_child();
        execv(argv.front(), argv.data());
        _exit(127);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        if (child_ <= 0) return;
        kill(child_, SIGKILL);
        waitpid(child_, nullptr, 0);
    }

    void send(int signal_number) const { kill(child_, signal_number); }

    /// Waits until `condition` holds; false if the program ended, or two minutes passed, before it did.
    bool wait_until(const std::function<bool()>& condition) {
        for (int i = 0; i < 24000; ++i) {
            if (condition()) return true;
            siginfo_t info{};
            if (waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child_)
                return condition();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }

    std::string err_so_far() const { return read_text(outputs_ / "err"); }

    Outcome finish() {
        int status = 0;
        struct rusage usage {};
        wait4(child_, &status, 0, &usage);
        child_ = -1;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(outputs_ / "out"),
                read_text(outputs_ / "err"), 1024.0 * static_cast<double>(usage.ru_maxrss)};
    }

private:
    TemporaryFolder outputs_;
    pid_t child_ = -1;
};

inline Outcome run_program(const fs::path& directory, std::vector<std::string> arguments,
                           const std::function<void()>& in_child = {}) {
    return Program(directory, std::move(arguments), in_child).finish();
}

/// A specimen of some forty grains, which breaks within a second.
inline std::string small_job(const std::string& tests = "[[test]]\nkind = \"uniaxial-compression\"\n",
                             const std::string& seeds = "[1]",
                             const std::string& numerics = "kind = \"adaptive\"\naccuracy = \"10 %\"\n") {
    return R"([specimen]
shape = "rectangle"
width = "40 mm"
height = "80 mm"
thickness = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "7 mm", maximum = "11 mm" }
porosity = 0.10
[material.grain]
E = "25.8 GPa"
nu = 0.23
[material.contact]
Kn = "18.00e4 GPa/m"
eta = 0.28
sigma_nt = "8.5 MPa"
tau = "29.75 MPa"
mu = 0.40
Gfn = "20 N/m"
Gfs = "800 N/m"
[numerics]
)" + numerics +
           tests + "[run]\nseeds = " + seeds + "\nthreads = 1\n";
}

/// The text with `from` replaced by `to`, once.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("there is no '" + from + "'");
    return text.replace(at, from.size(), to);
}

/// Nothing half-written: no file is left under a temporary name.
inline void expect_no_half_files(const fs::path& directory) {
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        const std::string file = entry.path().filename().string();
        EXPECT_FALSE(file.front() == '.' || entry.path().extension() == ".part") << entry.path();
    }
}

}  // namespace feldspar::testing_program
