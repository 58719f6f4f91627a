// Exceptions that say that the system has too little memory, in words for the user.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <system_error>

namespace feldspar {

/// "there is not enough memory for this job", where the exception says so: memory was asked for in vain, or by a thread that
/// could not be started; else empty. @param what  what it is not enough for
inline std::string lack_of_memory(const std::exception& error, const std::string& what) {
    std::string words = "there is not enough memory for " + what;
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return words;
    const auto* of_system = dynamic_cast<const std::system_error*>(&error);
    const bool thread = of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again;
    return thread ? words + ": no further thread can be started" : std::string();
}

}  // namespace feldspar
