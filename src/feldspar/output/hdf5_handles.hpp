// What writing and reading archives share of the HDF5 library.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <mutex>
#include <new>
#include <string>
#include <string_view>

#include "feldspar/base/error.hpp"

namespace feldspar {

/// The version of an archive's contents. 1, without a number of its own: no contacts. 2: /contacts, and their damage and forces
/// in snapshots.
inline constexpr int archive_version = 2;

/// The library is not made for several threads: whoever calls it holds this.
std::mutex& hdf5_mutex();

/// What the library would do at the end of the program is to write open files. There are none on disk; and after a failed call it
/// can crash there. To be called before its first use.
void hdf5_closes_nothing();

/// The first description on HDF5's error stack: the cause.
inline std::string hdf5_reason() {
    std::string text = "HDF5 failed";
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned number, const H5E_error2_t* error, void* into) -> herr_t {
            if (number == 0 && error->desc != nullptr) *static_cast<std::string*>(into) = error->desc;
            return 0;
        },
        &text);
    return text;
}

/// Whether a failed call found too little memory.
inline bool memory_was_missing() {
    bool missing = false;
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned, const H5E_error2_t* error, void* into) -> herr_t {
            const std::string_view words = error->desc != nullptr ? error->desc : "";
            if (error->min_num == H5E_CANTALLOC || error->min_num == H5E_NOSPACE || words.find("alloc") != words.npos)
                *static_cast<bool*>(into) = true;
            return 0;
        },
        &missing);
    return missing;
}

/// @throws std::bad_alloc or OutputError if an HDF5 call failed (they all answer with a negative number).
template <class Result>
Result require(Result result) {
    if (result < 0 && memory_was_missing()) throw std::bad_alloc();
    if (result < 0) throw OutputError(hdf5_reason());
    return result;
}

/// An HDF5 identifier that closes itself.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t)) : id_(require(id)), close_(close) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { close_(id_); }
    operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): it stands for the identifier

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Keeps HDF5 from printing while it lives.
class Silence {
public:
    Silence() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

template <class Number>
hid_t type_of();
template <>
inline hid_t type_of<double>() {
    return H5T_NATIVE_DOUBLE;
}
template <>
inline hid_t type_of<float>() {
    return H5T_NATIVE_FLOAT;
}
template <>
inline hid_t type_of<int>() {
    return H5T_NATIVE_INT;
}
template <>
inline hid_t type_of<std::int64_t>() {
    return H5T_NATIVE_INT64;
}

}  // namespace feldspar
