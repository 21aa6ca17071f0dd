#pragma once

#include <stdexcept>
#include <string>

namespace evo {

/// The category of an error; its value is the exit code of the process.
enum class ErrorKind {
  kUsage = 2,                ///< the command line is wrong
  kConfiguration = 3,        ///< a parameter is unknown, of the wrong type or out of range
  kInput = 4,                ///< an input is missing, unreadable or corrupt
  kNothingToDo = 5,          ///< no overlap, an empty interval
  kTrackingLost = 6,         ///< no trajectory could be estimated
  kDegenerateAlignment = 7,  ///< the trajectories do not determine the requested alignment
  kOutput = 8,               ///< a result cannot be written
};

/// The exception of all stages. Its message is one line that names the file, the place in it (line, offset or data set)
/// and the remedy.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  ErrorKind kind() const { return kind_; }
  int exit_code() const { return static_cast<int>(kind_); }

 private:
  ErrorKind kind_;
};

}  // namespace evo
