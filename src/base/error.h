// The errors that reach the user. Every message says what was found, where, what is allowed and what to do next.
#pragma once

#include <stdexcept>
#include <string>

namespace lobefit {

// Exit codes of the program; design contract, never renumbered.
enum ExitCode : int { kExitDone = 0, kExitOther = 1, kExitUsage = 2, kExitInput = 3, kExitFit = 4 };

// An error that ends the program with its own exit code.
class Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& message) : std::runtime_error(message), exit_code_(exit_code) {}
  ExitCode exit_code() const { return exit_code_; }

 private:
  ExitCode exit_code_;
};

// Wrong usage: an unknown option, verb or name (exit 2).
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(kExitUsage, message) {}
};

// Input that cannot be read or is not valid (exit 3).
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(kExitInput, message) {}
};

// An output that cannot be written (exit 3: a path that the user gave is not usable).
class OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(kExitInput, message) {}
};

}  // namespace lobefit
