// What a function that can fail returns: the value, or one clear sentence (or, in real-time code, a code).
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace orcart {

/// One sentence for a person: names the file, the value, and what would be accepted. Off the real-time path.
struct Error {
  std::string message;
};

/// A value or an error. Real-time code uses an enumeration for E, so that nothing is allocated.
template <class T, class E = Error>
using Result = tl::expected<T, E>;

/// Returns an Error from a function whose return type is some Result<T>.
[[nodiscard]] inline tl::unexpected<Error> fail(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace orcart
