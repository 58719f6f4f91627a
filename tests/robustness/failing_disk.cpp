// A disk that fails when it is told to: loaded before the C library (LD_PRELOAD), it lets a call on files below one directory
// fail.
//
//   FAILING_DISK_BELOW   the directory, absolute and without links; nothing fails if it is not set
//   FAILING_DISK_KIND    write, short, fsync, rename, open, close, mkdir, truncate or unlink
//   FAILING_DISK_CALL    the number of the call of this kind that fails, from 1; 0: none
//   FAILING_DISK_ERROR   its errno, as a number
//   FAILING_DISK_ONWARD  1: all later calls of this kind fail too
//   FAILING_DISK_LOG     a file that gets a line for every call: "kind path", with "! " before those that failed
//
// A write that fails has written half of its bytes, as a disk does that is torn off. One that is `short` writes half and says so.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>

namespace {

struct Settings {
    const char* below = getenv("FAILING_DISK_BELOW");
    const char* kind = text("FAILING_DISK_KIND");
    long call = number("FAILING_DISK_CALL");
    int error = static_cast<int>(number("FAILING_DISK_ERROR"));
    bool onward = number("FAILING_DISK_ONWARD") != 0;
    int log = getenv("FAILING_DISK_LOG") != nullptr ? static_cast<int>(syscall(SYS_openat, AT_FDCWD, getenv("FAILING_DISK_LOG"),
                                                                               O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600))
                                                    : -1;

    static const char* text(const char* name) { return getenv(name) != nullptr ? getenv(name) : ""; }
    static long number(const char* name) { return strtol(text(name), nullptr, 10); }
};

const Settings& settings() {
    static const Settings all;
    return all;
}

std::atomic<long> calls{0};

bool is_below(const char* path) {
    const char* below = settings().below;
    const std::size_t length = strlen(below);
    return strncmp(path, below, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

// Whether this call on `path`, which is absolute, is to fail; errno is set then.
bool path_fails(const char* kind, const char* path) {
    if (!is_below(path)) return false;
    const Settings& set = settings();
    // a short write is a write, so that both are counted alike
    const bool counts = strcmp(set.kind, kind) == 0 || (strcmp(set.kind, "short") == 0 && strcmp(kind, "write") == 0);
    const long here = counts ? calls.fetch_add(1) + 1 : 0;
    const bool fails = counts && set.call > 0 && (here == set.call || (set.onward && here > set.call));
    if (set.log >= 0) {
        char line[PATH_MAX + 32];
        const int length = snprintf(line, sizeof line, "%s%s %s\n", fails ? "! " : "", kind, path);
        syscall(SYS_write, set.log, line, static_cast<std::size_t>(length));
    }
    if (fails) errno = set.error;
    return fails;
}

bool fails(const char* kind, const char* path, int directory = AT_FDCWD) {
    if (settings().below == nullptr || path == nullptr) return false;
    if (path[0] == '/') return path_fails(kind, path);
    char whole[2 * PATH_MAX] = {};
    if (directory == AT_FDCWD) {
        if (syscall(SYS_getcwd, whole, PATH_MAX) < 0) return false;
    } else {
        char link[64];
        snprintf(link, sizeof link, "/proc/self/fd/%d", directory);
        if (syscall(SYS_readlink, link, whole, PATH_MAX - 1) < 0) return false;
    }
    strncat(whole, "/", 2);
    strncat(whole, path, PATH_MAX - 1);
    return path_fails(kind, whole);
}

bool fails(const char* kind, int file) {
    if (settings().below == nullptr) return false;
    const int before = errno;
    char link[64], path[PATH_MAX] = {};
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const bool known = syscall(SYS_readlink, link, path, sizeof path - 1) >= 0;
    errno = before;
    return known && path_fails(kind, path);
}

bool is_short() { return strcmp(settings().kind, "short") == 0; }

template <class Function>
Function next(Function, const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool for_writing(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }

// Half of the bytes are written; then the call says so, or fails.
template <class Write>
ssize_t torn(std::size_t count, Write write_some) {
    const int error = errno;
    const ssize_t written = write_some(is_short() ? (count + 1) / 2 : count / 2);
    if (is_short()) return written;
    errno = error;
    return -1;
}

}  // namespace

#define REAL(name) static const auto real = next(&name, #name)

extern "C" {

ssize_t write(int file, const void* data, std::size_t count) {
    REAL(write);
    if (fails("write", file)) return torn(count, [&](std::size_t half) { return real(file, data, half); });
    return real(file, data, count);
}

ssize_t writev(int file, const iovec* parts, int count) {
    REAL(writev);
    if (!fails("write", file)) return real(file, parts, count);
    for (int i = 0; i < count; ++i)  // of the first part that has something
        if (parts[i].iov_len > 0)
            return torn(parts[i].iov_len, [&](std::size_t half) { return syscall(SYS_write, file, parts[i].iov_base, half); });
    return is_short() ? 0 : -1;
}

ssize_t pwrite(int file, const void* data, std::size_t count, off_t at) {
    REAL(pwrite);
    if (fails("write", file)) return torn(count, [&](std::size_t half) { return real(file, data, half, at); });
    return real(file, data, count, at);
}

ssize_t pwrite64(int file, const void* data, std::size_t count, off64_t at) {
    REAL(pwrite64);
    if (fails("write", file)) return torn(count, [&](std::size_t half) { return real(file, data, half, at); });
    return real(file, data, count, at);
}

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* stream) {
    REAL(fwrite);
    return fails("write", fileno(stream)) && !is_short() ? 0 : real(data, size, count, stream);
}

int fsync(int file) {
    REAL(fsync);
    return fails("fsync", file) ? -1 : real(file);
}

int fdatasync(int file) {
    REAL(fdatasync);
    return fails("fsync", file) ? -1 : real(file);
}

int rename(const char* from, const char* to) {
    REAL(rename);
    return fails("rename", to) ? -1 : real(from, to);
}

int renameat(int from_directory, const char* from, int to_directory, const char* to) {
    REAL(renameat);
    return fails("rename", to, to_directory) ? -1 : real(from_directory, from, to_directory, to);
}

#define OPEN(name)                                                                           \
    int name(const char* path, int flags, ...) {                                             \
        REAL(name);                                                                          \
        va_list more;                                                                        \
        va_start(more, flags);                                                               \
        const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0; \
        va_end(more);                                                                        \
        return for_writing(flags) && fails("open", path) ? -1 : real(path, flags, mode);     \
    }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                                                           \
    int name(int directory, const char* path, int flags, ...) {                                                \
        REAL(name);                                                                                            \
        va_list more;                                                                                          \
        va_start(more, flags);                                                                                 \
        const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;                   \
        va_end(more);                                                                                          \
        return for_writing(flags) && fails("open", path, directory) ? -1 : real(directory, path, flags, mode); \
    }
OPENAT(openat)
OPENAT(openat64)

FILE* fopen(const char* path, const char* mode) {
    REAL(fopen);
    return strpbrk(mode, "wa+") != nullptr && fails("open", path) ? nullptr : real(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
    REAL(fopen64);
    return strpbrk(mode, "wa+") != nullptr && fails("open", path) ? nullptr : real(path, mode);
}

// A file that cannot be closed is closed all the same. Those that were only read are let alone.
int close(int file) {
    REAL(close);
    const int flags = settings().below != nullptr ? fcntl(file, F_GETFL) : -1;
    if (flags < 0 || !for_writing(flags) || !fails("close", file)) return real(file);
    const int error = errno;
    real(file);
    errno = error;
    return -1;
}

int fclose(FILE* stream) {
    REAL(fclose);
    const int flags = settings().below != nullptr ? fcntl(fileno(stream), F_GETFL) : -1;
    if (flags < 0 || !for_writing(flags) || !fails("close", fileno(stream))) return real(stream);
    const int error = errno;
    real(stream);
    errno = error;
    return EOF;
}

int mkdir(const char* path, mode_t mode) {
    REAL(mkdir);
    return fails("mkdir", path) ? -1 : real(path, mode);
}

int mkdirat(int directory, const char* path, mode_t mode) {
    REAL(mkdirat);
    return fails("mkdir", path, directory) ? -1 : real(directory, path, mode);
}

int ftruncate(int file, off_t length) {
    REAL(ftruncate);
    return fails("truncate", file) ? -1 : real(file, length);
}

int ftruncate64(int file, off64_t length) {
    REAL(ftruncate64);
    return fails("truncate", file) ? -1 : real(file, length);
}

int fallocate(int file, int mode, off_t from, off_t length) {
    REAL(fallocate);
    return fails("truncate", file) ? -1 : real(file, mode, from, length);
}

int posix_fallocate(int file, off_t from, off_t length) {  // gives the error back instead of setting errno
    REAL(posix_fallocate);
    return fails("truncate", file) ? errno : real(file, from, length);
}

int unlink(const char* path) {
    REAL(unlink);
    return fails("unlink", path) ? -1 : real(path);
}

int unlinkat(int directory, const char* path, int flags) {
    REAL(unlinkat);
    return fails("unlink", path, directory) ? -1 : real(directory, path, flags);
}

int rmdir(const char* path) {
    REAL(rmdir);
    return fails("unlink", path) ? -1 : real(path);
}

int remove(const char* path) {
    REAL(remove);
    return fails("unlink", path) ? -1 : real(path);
}

}  // extern "C"
