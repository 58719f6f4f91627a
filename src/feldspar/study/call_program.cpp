#include "feldspar/study/call_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "feldspar/base/error.hpp"

extern char** environ;

namespace feldspar {
namespace {

// The two ends of a pipe, which close themselves.
class Pipe {
public:
    Pipe() {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw OutputError(fmt::format("no pipe: {}", std::strerror(errno)));
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close(0);
        close(1);
    }
    int reading() const { return ends_[0]; }
    int writing() const { return ends_[1]; }
    void close(std::size_t end) {
        if (ends_[end] >= 0) ::close(ends_[end]);
        ends_[end] = -1;
    }

private:
    std::array<int, 2> ends_{-1, -1};
};

// How the child is started: its directory, its ends of the pipes, and signals as a program expects them.
class Start {
public:
    Start(const std::filesystem::path& directory, const Pipe& out, const Pipe& err) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, directory.c_str());
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&actions_, out.writing(), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, err.writing(), STDERR_FILENO);
        posix_spawnattr_init(&attributes_);
        sigset_t defaults;
        sigemptyset(&defaults);
        sigaddset(&defaults, SIGPIPE);
        sigaddset(&defaults, SIGXFSZ);
        posix_spawnattr_setsigdefault(&attributes_, &defaults);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
    }
    Start(const Start&) = delete;
    Start& operator=(const Start&) = delete;
    ~Start() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    int spawn(pid_t& child, std::vector<char*>& arguments) const {
        return posix_spawnp(&child, arguments.front(), &actions_, &attributes_, arguments.data(), environ);
    }

private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

// Takes what there is to read; false at the end.
bool take(int descriptor, std::string& text) {
    std::array<char, 4096> piece;
    const ssize_t count = ::read(descriptor, piece.data(), piece.size());
    if (count > 0) text.append(piece.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
}

// Reads both pipes to their ends, whichever has something.
void listen(const Pipe& out, const Pipe& err, CallResult& result) {
    std::array<pollfd, 2> sources{pollfd{out.reading(), POLLIN, 0}, pollfd{err.reading(), POLLIN, 0}};
    const std::array<std::string*, 2> texts{&result.out, &result.err};
    while (sources[0].fd >= 0 || sources[1].fd >= 0) {
        if (::poll(sources.data(), sources.size(), -1) < 0 && errno != EINTR) return;
        for (std::size_t i = 0; i < sources.size(); ++i)
            if (sources[i].fd >= 0 && sources[i].revents != 0 && !take(sources[i].fd, *texts[i])) sources[i].fd = -1;
    }
}

}  // namespace

std::optional<CallResult> call_program(const std::vector<std::string>& command, const std::filesystem::path& directory) {
    Pipe out, err;
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = -1;
    const int problem = Start(directory, out, err).spawn(child, arguments);
    if (problem == ENOENT && std::filesystem::is_directory(directory)) return std::nullopt;
    if (problem != 0) throw OutputError(fmt::format("'{}' cannot be started: {}", command.front(), std::strerror(problem)));
    out.close(1);
    err.close(1);
    CallResult result;
    listen(out, err, result);
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

}  // namespace feldspar
