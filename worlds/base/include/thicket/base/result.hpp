// What a loader returns: the thing itself, or a message a person can act on.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace thicket {

/// Why something could not be done, in words: `file:line:column: what is wrong, what was expected`.
/// Several faults of one file stand in one message, one per line.
struct Error {
  std::string message;
};

/// A `T` or an `Error`. Libraries return it instead of printing, exiting or throwing.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}

  explicit operator bool() const { return content_.index() == 0; }
  T& operator*() { return std::get<0>(content_); }
  const T& operator*() const { return std::get<0>(content_); }
  T* operator->() { return &std::get<0>(content_); }
  const T* operator->() const { return &std::get<0>(content_); }
  const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

/// Success without a value, for functions that write.
struct Done {};

}  // namespace thicket
