#include "feldspar/base/state_archive.hpp"

#include <algorithm>

#include <xxhash.h>

namespace feldspar {
namespace {

// How a column stands in the file.
enum class Stands : unsigned char {
    here,    // its bytes follow
    as_base, // as in the base state, with this checksum
    as_before,   // as the column with this number
    zeros
};

constexpr std::size_t kSmall = 64;   // bytes: shorter columns just stand there

bool all_zero(const char* data, std::size_t bytes) {
    return std::all_of(data, data + bytes, [](char byte) { return byte == 0; });
}

}  // namespace

std::uint64_t hash_of_bytes(const void* data, std::size_t bytes) { return XXH3_64bits(data, bytes); }

void StateWriter::count(std::size_t& count) {
    const std::uint64_t value = count;
    put_(&value, sizeof value);
}

void StateWriter::column(const char* data, std::size_t bytes) {
    if (bytes == 0) return;
    const auto stands = [&](Stands how) { put_(&how, sizeof how); };
    if (bytes <= kSmall) {
        stands(Stands::here);
        put_(data, bytes);
        return;
    }
    const std::uint64_t hash = hash_of_bytes(data, bytes);
    if (base_.has(path(), bytes, hash)) {
        stands(Stands::as_base);
        put_(&hash, sizeof hash);
        return;
    }
    if (all_zero(data, bytes)) return stands(Stands::zeros);
    const auto [known, is_new] = written_.try_emplace({bytes, hash}, written_.size());
    if (!is_new) {
        stands(Stands::as_before);
        put_(&known->second, sizeof known->second);
        return;
    }
    stands(Stands::here);
    put_(data, bytes);
}

std::size_t StateWriter::number_of(const void* object) {
    if (object == nullptr) return 0;
    return objects_.try_emplace(object, objects_.size() + 1).first->second;
}

bool StateWriter::is_new(std::size_t number) {
    if (number <= objects_seen_) return false;
    objects_seen_ = number;
    return true;
}

std::span<const char> StateReader::next(std::size_t count) {
    if (count > data_.size() - at_) throw StateError("it ends too early");
    const std::span<const char> found = data_.subspan(at_, count);
    at_ += count;
    return found;
}

void StateReader::bytes(void* data, std::size_t count) {
    const std::span<const char> found = next(count);
    std::copy(found.begin(), found.end(), static_cast<char*>(data));
}

void StateReader::count(std::size_t& count) {
    std::uint64_t value = 0;
    bytes(&value, sizeof value);
    count = value;
}

void StateReader::column(char* data, std::size_t bytes_of_it) {
    if (bytes_of_it == 0) return;
    Stands how{};
    bytes(&how, sizeof how);
    switch (how) {
        case Stands::here: {
            const std::span<const char> column = next(bytes_of_it);
            std::copy(column.begin(), column.end(), data);
            if (bytes_of_it > kSmall) columns_.push_back(column);
            return;
        }
        case Stands::as_base: {
            std::uint64_t hash = 0;
            bytes(&hash, sizeof hash);
            if (hash_of_bytes(data, bytes_of_it) != hash) throw StateError("it is of another specimen, or of another version of the program");
            return;
        }
        case Stands::as_before: {
            std::uint64_t number = 0;
            bytes(&number, sizeof number);
            if (number >= columns_.size() || columns_[number].size() != bytes_of_it) throw StateError("a part refers to one that is not there");
            std::copy(columns_[number].begin(), columns_[number].end(), data);
            return;
        }
        case Stands::zeros: std::fill(data, data + bytes_of_it, char{}); return;
    }
    throw StateError("a part begins with a mark that is none");
}

void StateReader::learn(std::size_t number, std::shared_ptr<const void> object) {
    if (number != objects_.size() + 1) throw StateError("an object stands in the wrong place");
    objects_.push_back(std::move(object));
}

}  // namespace feldspar
