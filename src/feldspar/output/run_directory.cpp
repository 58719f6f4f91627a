// The run's directory. Every file is written aside, flushed to the disk, and renamed when it is whole.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>
#include <regex>
#include <string_view>
#include <system_error>

#include "feldspar/base/error.hpp"
#include "feldspar/output/results.hpp"

namespace feldspar {

namespace fs = std::filesystem;

namespace {

constexpr unsigned long long smallest_space_B = 1ULL << 20;  ///< with less than this a run is refused before it starts

std::string reason(int error) { return std::strerror(error); }

[[noreturn]] void refuse(const std::string& problem, const std::string& allowed = {}) {
    throw InputError({.file = "", .line = 0, .column = 0, .key = "--out"}, problem, allowed);
}

/// This machine's name without dots and the like.
std::string machine() {
    char name[256] = {};
    if (::gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return "unknown";
    std::string plain = name;
    for (char& letter : plain)
        if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
    return plain;
}

/// Of the system: nothing that is computed may depend on it.
unsigned unforeseen_number() {
    unsigned number = 0;
    return ::getrandom(&number, sizeof number, GRND_NONBLOCK) == sizeof number ? number / 2
                                                                               : 0;  // so that counting on does not begin anew
}

/// Where a file is written before it is renamed to `path`: ".summary.json.4711-2-machine.part". Process, counter and machine keep
/// programs and threads that write the same file at once apart; the last one to rename its own wins.
fs::path aside_of(const fs::path& path) {
    static std::atomic<unsigned> counter{unforeseen_number()};  // so that nobody can put a link there beforehand
    return path.parent_path() / fmt::format(".{}.{}-{}-{}.part", path.filename().string(), ::getpid(), ++counter, machine());
}

/// What the name of a file that is written aside says.
struct Aside {
    std::string file;  ///< its final name
    pid_t process = 0;
    std::string machine;
};

std::optional<Aside> read_aside(const std::string& name) {
    static const std::regex form(R"(\.(.+)\.([0-9]{1,9})-[0-9]+-([^.]+)\.part)");
    std::smatch match;
    if (!std::regex_match(name, match, form)) return std::nullopt;
    return Aside{match[1], static_cast<pid_t>(std::stol(match[2])), match[3]};
}

/// Whether nobody writes it any more: its process is gone. One of another machine cannot be asked for: there it has not grown for
/// a day.
bool left_behind(const fs::path& path) {
    const std::optional<Aside> aside = read_aside(path.filename().string());
    if (!aside) return false;
    if (aside->machine == machine()) return ::kill(aside->process, 0) != 0 && errno == ESRCH;
    std::error_code error;
    const auto written = fs::last_write_time(path, error);
    return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(24);
}

[[noreturn]] void lost(fs::path path, const std::string& why) {
    if (const auto aside = read_aside(path.filename().string()))
        path = path.parent_path() / aside->file;  // the user knows the file by its final name
    throw OutputError(fmt::format("cannot write '{}': {}", path.string(), why));
}

/// A file descriptor that closes itself on the way out.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int number() const { return number_; }
    /// Closes now and says whether that worked: some file systems report a full disk only here.
    bool close() {
        const int result = ::close(number_);
        number_ = -1;
        return result == 0;
    }

private:
    int number_;
};

/// Makes a write beyond the file-size limit fail with EFBIG, like a full disk, instead of ending the program: SIGXFSZ is
/// held back in this thread and dropped.
class HoldFileSizeSignal {
public:
    HoldFileSizeSignal() {
        sigemptyset(&signal_);
        sigaddset(&signal_, SIGXFSZ);
        pthread_sigmask(SIG_BLOCK, &signal_, &before_);
    }
    HoldFileSizeSignal(const HoldFileSizeSignal&) = delete;
    HoldFileSizeSignal& operator=(const HoldFileSizeSignal&) = delete;
    ~HoldFileSizeSignal() {
        const timespec now{};
        while (sigtimedwait(&signal_, nullptr, &now) == SIGXFSZ) {
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

private:
    sigset_t signal_{};
    sigset_t before_{};
};

/// The nearest directory on the way up from `path` that exists: where the missing ones would be made.
fs::path nearest_existing(fs::path path) {
    std::error_code error;
    path = fs::absolute(path, error);
    while (!fs::exists(fs::symlink_status(path, error)) && path.has_parent_path() && path.parent_path() != path)
        path = path.parent_path();
    return path;
}

/// @throws InputError if a directory cannot be made below `place`, or if the disk is full.
void check_place(const fs::path& place, const fs::path& wanted) {
    std::error_code error;
    if (!fs::is_directory(place, error)) {
        refuse(fmt::format("cannot make the directory '{}': '{}' is not a directory", wanted.string(), place.string()));
    }
    if (::faccessat(AT_FDCWD, place.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
        refuse(fmt::format("cannot make the directory '{}': '{}': {}", wanted.string(), place.string(), reason(errno)),
               "a directory in which you may write");
    }
    struct statvfs space {};
    if (::statvfs(place.c_str(), &space) == 0 && space.f_blocks > 0) {
        const unsigned long long available_B = static_cast<unsigned long long>(space.f_bavail) * space.f_frsize;
        if (available_B < smallest_space_B) {
            refuse(fmt::format("no space for results in '{}': {} kB are free", place.string(), available_B / 1024),
                   "a disk with at least 1 MB free (fields and histories of a test take some 10 MB)");
        }
    }
}

void refuse_existing(const fs::path& wanted) {
    std::error_code error;
    if (wanted.empty()) refuse("an empty directory name");
    if (fs::exists(fs::symlink_status(wanted, error))) {
        refuse(fmt::format("'{}' exists already; results are never overwritten", wanted.string()),
               "a directory that does not exist yet, or no --out for a new numbered one");
    }
}

/// A job name as part of a file name: letters, digits, '-', '_' and '.' stay, everything else becomes '-'.
std::string file_name_of(const std::string& job_name) {
    std::string name;
    for (const char letter : job_name) {
        const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                           (letter >= '0' && letter <= '9') || letter == '-' || letter == '_' || letter == '.';
        name += plain ? letter : '-';
    }
    return name.empty() ? "job" : name;
}

const fs::path results_directory = "results";

/// An empty file that was not there before. Its writers open it by its name: in a directory that others may write to, a link in
/// its place would lead them anywhere.
void make_new(const fs::path& path) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.number() < 0) lost(path, reason(errno));
    if (!file.close()) {
        const int error = errno;
        ::unlink(path.c_str());
        lost(path, reason(error));
    }
}

void write_bytes(const fs::path& path, std::string_view bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC | O_NOFOLLOW));
    if (file.number() < 0) lost(path, reason(errno));
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            lost(path, reason(errno));
        }
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (!file.close()) lost(path, reason(errno));
}

/// @throws OutputError unless every byte of `path` is on the disk. A directory is flushed where its file system can do so.
void flush_to_disk(const fs::path& path, bool directory) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | (directory ? O_DIRECTORY : 0)));
    if (file.number() < 0) lost(path, reason(errno));
    if (::fsync(file.number()) != 0 && !(directory && (errno == EINVAL || errno == EACCES || errno == EBADF)))
        lost(path, reason(errno));
    if (!file.close()) lost(path, reason(errno));
}

}  // namespace

void RunDirectory::check(const std::optional<fs::path>& wanted, const std::string& job_name) {
    if (wanted) {
        refuse_existing(*wanted);
        check_place(nearest_existing(*wanted), *wanted);
    } else {
        check_place(nearest_existing(results_directory), results_directory / (file_name_of(job_name) + "-1"));
    }
}

RunDirectory RunDirectory::create(const std::optional<fs::path>& wanted, const std::string& job_name) {
    check(wanted, job_name);
    const fs::path parent = wanted ? fs::absolute(*wanted).parent_path() : results_directory;
    std::error_code error;
    fs::create_directories(parent, error);
    if (error) refuse(fmt::format("cannot make the directory '{}': {}", parent.string(), error.message()));
    // mkdir both makes and claims the name, so that two runs started at once never share a directory
    for (int number = 1;; ++number) {
        const fs::path path = wanted ? *wanted : parent / fmt::format("{}-{}", file_name_of(job_name), number);
        if (::mkdir(path.c_str(), 0777) == 0) return RunDirectory(path);
        if (errno != EEXIST) refuse(fmt::format("cannot make the directory '{}': {}", path.string(), reason(errno)));
        if (wanted) refuse_existing(path);
    }
}

std::optional<fs::path> RunDirectory::newest(const std::string& job_name) {
    const std::string stem = file_name_of(job_name) + "-";
    std::optional<fs::path> newest;
    unsigned long long largest = 0;
    std::error_code error;
    for (fs::directory_iterator entry(results_directory, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        unsigned long long number = 0;
        if (!name.starts_with(stem)) continue;
        const auto [behind, problem] = std::from_chars(name.data() + stem.size(), name.data() + name.size(), number);
        if (problem != std::errc() || behind != name.data() + name.size() || number <= largest) continue;
        largest = number;
        newest = entry->path();
    }
    return newest;
}

RunDirectory RunDirectory::open(fs::path path) {
    std::error_code error, ignored;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
        if (left_behind(entry->path())) fs::remove(entry->path(), ignored);
    return RunDirectory(std::move(path));
}

namespace {

void write_whole(const fs::path& directory, const std::string& name, const std::function<void(const fs::path&)>& fill,
                 bool may_be_empty) {
    const fs::path path = directory / name;
    const fs::path aside = aside_of(path);
    const HoldFileSizeSignal hold;
    if (path.parent_path() != directory && ::mkdir(path.parent_path().c_str(), 0777) != 0 && errno != EEXIST) {
        lost(path.parent_path(), reason(errno));
    }
    make_new(aside);
    try {
        fill(aside);
        if (!may_be_empty && fs::file_size(aside) == 0) lost(path, "nothing was written");
        flush_to_disk(aside, false);
        if (::rename(aside.c_str(), path.c_str()) != 0) lost(path, reason(errno));
    } catch (const std::system_error& problem) {  // also std::filesystem and stream failures
        ::unlink(aside.c_str());
        lost(path, problem.code().message());
    } catch (...) {
        ::unlink(aside.c_str());
        throw;
    }
    flush_to_disk(path.parent_path(), true);
}

}  // namespace

void RunDirectory::write(const std::string& name, const std::function<void(const fs::path&)>& fill) const {
    write_whole(path_, name, fill, false);
}

void RunDirectory::write_text(const std::string& name, const std::string& text) const {
    write_whole(
        path_, name, [&](const fs::path& aside) { write_bytes(aside, text); }, true);
}

}  // namespace feldspar
