#pragma once

#include <string>

#include "evo/core/error.hpp"

namespace evo::app {

/// Calls `work` and returns what it returns; an Error of a stage that knows data but no files gets `place` in front.
/// One about a result, or one that names the place already, stays as it is.
template <typename Work>
auto NamingPlace(const std::string& place, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (error.kind() == ErrorKind::kOutput || message.starts_with(place)) throw;
    throw Error(error.kind(), place + ": " + message);
  }
}

}  // namespace evo::app
