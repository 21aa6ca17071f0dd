#pragma once

#include <string>

#include "evo/core/error.hpp"

namespace evo::app {

/// Calls `work` and returns its result; puts `place`, such as the input file, before the message of an Error, since a
/// stage knows data but no files. An Error about an output or with the place already stays as it is.
template <typename Work>
auto WithErrorContext(const std::string& place, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (error.kind() == ErrorKind::kOutput || message.starts_with(place)) throw;
    throw Error(error.kind(), place + ": " + message);
  }
}

}  // namespace evo::app
