// Saving and loading the state of something that runs, so that it goes on with the same bits.
//
// A state is described by the structures that hold it: archives go through all members of plain structures (base/members.hpp) and
// through what classes list in `keep`, so a member that is added later is kept without a word, or the program does not compile.
// Arrays are written column by column: of an array of structures each number of all elements together. A column is left out where
// it is as it was in the base state, which whoever loads makes anew, or as another column of the file. So what never changes
// costs nothing but its checksum.
//
// A class with private members lists them with a structured binding, which the compiler holds against the members there are:
//     template <class Archive> void keep(Archive& archive) { auto& [a, b] = *this; archive(a, b); }
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "feldspar/base/members.hpp"
#include "feldspar/base/running_hash.hpp"

namespace feldspar {

/// What is read is not what was written, or not of this state.
struct StateError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Specialised for a union or the like that is a block of doubles and no more.
template <class T>
inline constexpr bool kept_as_doubles = false;

namespace state_detail {

template <class T>
inline constexpr bool is_number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T>
struct ArrayOf : std::false_type {};
template <class T, std::size_t n>
struct ArrayOf<std::array<T, n>> : std::true_type {
    using Item = T;
};

template <class T>
concept BlockOfDoubles = kept_as_doubles<T>;

template <class T>
constexpr bool is_flat();

// Made of numbers alone.
template <class T>
constexpr bool is_flat() {
    if constexpr (is_number<T> || BlockOfDoubles<T>)
        return true;
    else if constexpr (ArrayOf<T>::value)
        return is_flat<typename ArrayOf<T>::Item>();
    else if constexpr (std::is_aggregate_v<T> && std::is_default_constructible_v<T> && !std::is_empty_v<T>) {
        return decltype(with_members(std::declval<T&>(), [](auto&... m) {
            return std::bool_constant<(is_flat<std::remove_cvref_t<decltype(m)>>() && ...)>{};
        }))::value;
    } else
        return false;
}

// Calls act(number) for every number in it.
template <class T, class Act>
void for_each_number(T& value, Act& act) {
    using Plain = std::remove_const_t<T>;
    if constexpr (is_number<Plain>)
        act(value);
    else if constexpr (BlockOfDoubles<Plain>) {
        using Byte = std::conditional_t<std::is_const_v<T>, const double, double>;
        Byte* doubles = reinterpret_cast<Byte*>(&value);
        for (std::size_t i = 0; i < sizeof(T) / sizeof(double); ++i) act(doubles[i]);
    } else if constexpr (ArrayOf<Plain>::value) {
        for (auto& item : value) for_each_number(item, act);
    } else {
        with_members(value, [&](auto&... m) { (for_each_number(m, act), ...); });
    }
}

// Bytes of each number of a flat structure.
template <class T>
std::vector<std::size_t> number_sizes() {
    std::vector<std::size_t> sizes;
    auto note = [&](auto& number) { sizes.push_back(sizeof number); };
    T value{};
    for_each_number(value, note);
    return sizes;
}

// All of its numbers have the same size, and nothing lies between them: an array of it is an array of these.
template <class T>
bool is_dense() {
    if constexpr (is_number<T>) return true;
    const std::vector<std::size_t> sizes = number_sizes<T>();
    for (const std::size_t size : sizes)
        if (size != sizes.front()) return false;
    return sizes.size() * sizes.front() == sizeof(T);
}

}  // namespace state_detail

/// What all archives do: they go through a value, and hand numbers, counts and the columns of arrays to `Derived`. Structures
/// that are not plain have a member keep(archive), or a function keep(archive, value) beside them.
template <class Derived>
class StateArchive {
public:
    template <class... T>
    void operator()(T&... values) {
        std::uint64_t number = 0;
        (at(number++, values), ...);
    }

protected:
    std::uint64_t path() const { return path_; }

private:
    Derived& self() { return static_cast<Derived&>(*this); }

    // The place of a value in the state is its number among its fellows, and theirs.
    template <class T>
    void at(std::uint64_t number, T& value) {
        const std::uint64_t before = path_;
        path_ = (path_ ^ (number + 1)) * 0x9E3779B97F4A7C15ULL;
        path_ ^= path_ >> 29;
        go_through(value);
        path_ = before;
    }

    template <class T>
    void go_through(T& value) {
        if constexpr (state_detail::is_number<T>)
            self().bytes(&value, sizeof value);
        else if constexpr (requires { value.keep(self()); })
            value.keep(self());
        else if constexpr (requires { keep(self(), value); })
            keep(self(), value);
        else if constexpr (std::is_aggregate_v<T>)
            with_members(value, [&](auto&... m) { (*this)(m...); });
        else
            static_assert(!sizeof(T), "an archive does not know how to keep this");
    }
    void go_through(std::string& text) {
        std::size_t size = text.size();
        self().count(size);
        if constexpr (Derived::reads) self().resize(text, size);
        self().bytes(text.data(), size);
    }
    template <class T, std::size_t n>
    void go_through(std::array<T, n>& values) {
        for (std::size_t i = 0; i < n; ++i) at(i, values[i]);
    }
    template <class A, class B>
    void go_through(std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <class T>
    void go_through(std::optional<T>& value) {
        std::size_t there = value.has_value();
        self().count(there);
        if (there > 1) throw StateError("neither there nor absent");
        if (there == 0) value.reset();
        if constexpr (std::is_default_constructible_v<T>) {
            if (there == 1 && !value) value.emplace();
        } else if (there == 1 && !value) {
            throw StateError("something stands there that this state has not");
        }
        if (value) at(0, *value);
    }
    template <class T, class A>
    void go_through(std::vector<T, A>& values) {
        static_assert(!std::is_same_v<T, bool>);
        std::size_t size = values.size();
        self().count(size);
        if constexpr (Derived::reads) self().resize(values, size);
        if constexpr (state_detail::is_flat<T>()) {
            static const bool dense = state_detail::is_dense<T>();
            if (dense) {
                self().column(reinterpret_cast<char*>(values.data()), size * sizeof(T));
            } else {
                columns(values.data(), size);
            }
        } else {
            for (std::size_t i = 0; i < size; ++i) at(i, values[i]);
        }
    }
    // Each number of all elements together.
    template <class T>
    void columns(T* values, std::size_t size) {
        static const std::vector<std::size_t> sizes = state_detail::number_sizes<T>();
        std::vector<std::vector<char>> columns(sizes.size());
        for (std::size_t k = 0; k < sizes.size(); ++k) columns[k].resize(size * sizes[k]);
        for (std::size_t i = 0; i < size; ++i) {
            std::size_t k = 0;
            auto take = [&](auto& number) {
                std::memcpy(columns[k].data() + i * sizeof number, &number, sizeof number);
                ++k;
            };
            state_detail::for_each_number(values[i], take);
        }
        const std::uint64_t before = path_;
        for (std::size_t k = 0; k < sizes.size(); ++k) {
            path_ = (before ^ (k + 1)) * 0x9E3779B97F4A7C15ULL;
            self().column(columns[k].data(), columns[k].size());
        }
        path_ = before;
        if constexpr (Derived::reads) {
            for (std::size_t i = 0; i < size; ++i) {
                std::size_t k = 0;
                auto give = [&](auto& number) {
                    std::memcpy(&number, columns[k].data() + i * sizeof number, sizeof number);
                    ++k;
                };
                state_detail::for_each_number(values[i], give);
            }
        }
    }
    template <class K, class V>
    void go_through(std::unordered_map<K, V>& map) {  // in the order of the keys: that of the map is nobody's concern
        std::vector<std::pair<K, V>> items(map.begin(), map.end());
        std::sort(items.begin(), items.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
        go_through(items);
        if constexpr (Derived::reads) map = std::unordered_map<K, V>(items.begin(), items.end());
    }
    /// Several pointers to one object: it is kept once.
    template <class T>
    void go_through(std::shared_ptr<const T>& pointer) {
        std::size_t number = self().number_of(pointer.get());
        self().count(number);
        if constexpr (Derived::reads) {
            if (const auto known = self().known(number)) {
                pointer = std::static_pointer_cast<const T>(known);
                return;
            }
            if (number == 0) {
                pointer.reset();
                return;
            }
            auto made = std::make_shared<T>();
            self().learn(number, made);
            at(0, *made);
            pointer = std::move(made);
        } else if (self().is_new(number)) {
            at(0, const_cast<T&>(*pointer));
        }
    }

    std::uint64_t path_ = 0x243F6A8885A308D3ULL;
};

/// What the columns of a state were at a moment, by their checksums.
class StateBase : public StateArchive<StateBase> {
public:
    static constexpr bool reads = false;

    /// Notes the columns of these values, which stay as they are.
    template <class... T>
    static StateBase of(const T&... values) {
        StateBase base;
        base(const_cast<T&>(values)...);  // it only looks at them
        return base;
    }

    /// Whether the column at this place was the same.
    bool has(std::uint64_t path, std::size_t bytes, std::uint64_t hash) const {
        const auto found = columns_.find(path);
        return found != columns_.end() && found->second == std::pair{bytes, hash};
    }

    /// Of all of it.
    std::uint64_t fingerprint() const { return fingerprint_; }

    void bytes(const void* data, std::size_t count) { note(hash_of_bytes(data, count)); }
    void count(std::size_t& count) { note(count); }
    void column(const char* data, std::size_t bytes) {
        const std::uint64_t hash = hash_of_bytes(data, bytes);
        if (bytes > 0) columns_[path()] = {bytes, hash};
        note(hash);
    }
    std::size_t number_of(const void*) { return 0; }
    bool is_new(std::size_t) { return false; }

private:
    void note(std::uint64_t value) {
        const std::array<std::uint64_t, 2> both{fingerprint_, value};
        fingerprint_ = hash_of_bytes(both.data(), sizeof both);
    }

    std::uint64_t fingerprint_ = 0;
    std::unordered_map<std::uint64_t, std::pair<std::size_t, std::uint64_t>> columns_;
};

/// Where a state goes, piece by piece.
using StatePut = std::function<void(const void* data, std::size_t bytes)>;

/// Writes a state.
class StateWriter : public StateArchive<StateWriter> {
public:
    static constexpr bool reads = false;

    /// @param base  of the state that whoever loads makes anew
    StateWriter(StatePut put, const StateBase& base) : put_(std::move(put)), base_(base) {}

    /// Writes the values, which stay as they are.
    template <class... T>
    void write(const T&... values) {
        (*this)(const_cast<T&>(values)...);
    }

    void bytes(const void* data, std::size_t count) { put_(data, count); }
    void count(std::size_t& count);
    void column(const char* data, std::size_t bytes);
    std::size_t number_of(const void* object);
    bool is_new(std::size_t number);

private:
    StatePut put_;
    const StateBase& base_;
    std::map<std::pair<std::size_t, std::uint64_t>, std::uint64_t> written_;  // columns by size and checksum: their numbers
    std::unordered_map<const void*, std::size_t> objects_;
    std::size_t objects_seen_ = 0;
};

/// Reads a state into values that are in the base state. @throws StateError
class StateReader : public StateArchive<StateReader> {
public:
    static constexpr bool reads = true;

    /// @param data  what the writer put; stays while this reads
    explicit StateReader(std::span<const char> data) : data_(data) {}

    template <class... T>
    void read(T&... values) {
        (*this)(values...);
    }
    bool at_end() const { return at_ == data_.size(); }

    void bytes(void* data, std::size_t count);
    void count(std::size_t& count);
    void column(char* data, std::size_t bytes);
    template <class Values>
    void resize(Values& values, std::size_t size) {
        const std::size_t most = 64 * (data_.size() + values.size() * sizeof(typename Values::value_type)) +
                                 (std::size_t{1} << 20);  // bytes: a damaged count is no reason to ask for all memory
        if (size > most / sizeof(typename Values::value_type)) throw StateError("a count is too large");
        values.resize(size);
    }
    std::size_t number_of(const void*) { return 0; }
    std::shared_ptr<const void> known(std::size_t number) const {
        return number > 0 && number <= objects_.size() ? objects_[number - 1] : nullptr;
    }
    void learn(std::size_t number, std::shared_ptr<const void> object);

private:
    std::span<const char> next(std::size_t count);

    std::span<const char> data_;
    std::size_t at_ = 0;
    std::vector<std::span<const char>> columns_;  // those that others may refer to
    std::deque<std::vector<char>> unpacked_;      // of these, what does not stand in the data as it is
    std::vector<std::shared_ptr<const void>> objects_;
};

}  // namespace feldspar
