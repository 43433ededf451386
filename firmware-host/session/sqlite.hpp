// A thin hold on SQLite: a database and its statements close themselves, and every failure is one sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace orcart {

/// One prepared statement. Belongs to its Database, which must outlive it.
class Statement {
 public:
  /// Binds the values to ?1, ?2, ... and starts anew. Texts and bytes must live until the last step().
  template <class... Values>
  Statement& with(const Values&... values) {
    reset();
    int index = 0;
    (bind(++index, values), ...);
    return *this;
  }
  /// True: there is a row.
  Result<bool> step();

  std::int64_t integer(int column) const;
  double number(int column) const;
  /// Nothing where the column is NULL, or the row has no such column.
  std::optional<double> number_or_null(int column) const;
  std::string text(int column) const;
  Instant instant(int column) const { return instant_from_nanos(integer(column)); }
  /// Valid until the next step().
  std::span<const std::byte> bytes(int column) const;

 private:
  friend class Database;
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}
  void reset();
  void bind(int index, std::int64_t value);
  void bind(int index, std::uint64_t value) { bind(index, static_cast<std::int64_t>(value)); }
  void bind(int index, std::uint32_t value) { bind(index, static_cast<std::int64_t>(value)); }
  void bind(int index, int value) { bind(index, static_cast<std::int64_t>(value)); }
  void bind(int index, double value);
  /// NULL where there is none: with() has cleared what was bound.
  void bind(int index, const std::optional<double>& value) {
    if (value) bind(index, *value);
  }
  void bind(int index, std::string_view value);
  void bind(int index, std::span<const std::byte> value);
  void bind(int index, Instant value) { bind(index, nanos_since_zero(value)); }
  void bind(int index, Nanos value) { bind(index, std::int64_t{value.count()}); }

  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

class Database {
 public:
  enum class Mode : std::uint8_t { write, read, read_only };

  /// Of a file that exists. `read` also mends what a lost power supply left, where the folder may be written
  /// to. `read_only` believes that nobody writes the file, and writes nothing beside it either.
  static Result<Database> open(const std::filesystem::path& file, Mode mode);

  /// One or more statements without parameters and rows.
  Result<void> run(const std::string& sql);
  Result<Statement> prepare(std::string_view sql);
  /// The first column of the first row; 0 where there is none.
  Result<std::int64_t> integer(std::string_view sql);
  Result<std::string> text(std::string_view sql);

 private:
  struct Closer {
    void operator()(sqlite3* handle) const;
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}

  std::unique_ptr<sqlite3, Closer> handle_;
};

}  // namespace orcart
