// Failure as a value: a code for the exit status and one sentence for the user, naming file, place and
// remedy.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace diatom {

enum class ErrorCode {
   usage,       // the call itself was wrong
   unreadable,  // a file or its content
   unwritable,  // a file or folder
   invalid,     // an operation that the model does not allow
   unsupported, // understood, but nothing installed can do it
   cancelled,   // by the user
   unstable,    // a simulation diverged
   timeLimit,
   internal
};

struct Error
{
   ErrorCode code = ErrorCode::internal;
   std::string message;
};

/// Either a value or an Error. Reading the wrong one is a bug and ends the program with a message.
template<typename T>
class [[nodiscard]] Result
{
public:
   Result(T value) : m_state(std::in_place_index<0>, std::move(value)) {}
   Result(Error error) : m_state(std::in_place_index<1>, std::move(error)) {}

   bool ok() const { return m_state.index() == 0; }
   explicit operator bool() const { return ok(); }
   const T &value() const & { return std::get<0>(m_state); }
   T &value() & { return std::get<0>(m_state); }
   T &&value() && { return std::get<0>(std::move(m_state)); }
   const T &operator*() const & { return value(); }
   T &operator*() & { return value(); }
   T &&operator*() && { return std::get<0>(std::move(m_state)); }
   const T *operator->() const { return &value(); }
   T *operator->() { return &value(); }
   const Error &error() const { return std::get<1>(m_state); }

private:
   std::variant<T, Error> m_state;
};

template<>
class [[nodiscard]] Result<void>
{
public:
   Result() = default;
   Result(Error error) : m_failed(true), m_error(std::move(error)) {}

   bool ok() const { return !m_failed; }
   explicit operator bool() const { return ok(); }
   const Error &error() const { return m_error; }

private:
   bool m_failed = false;
   Error m_error;
};

using Status = Result<void>;

} // namespace diatom
