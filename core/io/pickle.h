#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace vitruvian {

class PickleFile;

enum class PickleKind {
  none,
  boolean,
  integer,
  real,
  text,        ///< str; also what Python 2 called str, which may hold any bytes
  bytes,       ///< bytes, bytearray
  list,        ///< list, tuple, set
  dictionary,  ///< dict
  global,      ///< a class or function, by name
  object,      ///< what a callable would have made of its arguments; it is never called
  persistent,  ///< something kept outside of the pickle, by its identifier
};

/// One value of a PickleFile, which must outlive it. Cheap to copy.
class PickleValue {
 public:
  PickleKind kind() const;
  bool is_none() const { return kind() == PickleKind::none; }

  /// Booleans, integers and reals; nothing for other kinds.
  std::optional<double> number() const;
  /// Content of text or bytes; empty for other kinds.
  std::string_view text() const;

  /// Elements of a list; for an object, those appended to it. 0 for other kinds.
  std::size_t size() const;
  PickleValue at(std::size_t index) const;

  /// Value of a text key: in a dictionary, in the items set on an object, or in the object's state.
  std::optional<PickleValue> find(std::string_view key) const;
  /// Text keys of a dictionary, or of the items set on an object, in the file's order.
  std::vector<std::string> keys() const;

  /// "module.name" of a global, or of the class or function that an object comes from; else empty.
  std::string class_name() const;
  /// Arguments of an object's callable.
  PickleValue arguments() const;
  /// What an object was told to restore (none when nothing), or the identifier of a persistent value.
  PickleValue state() const;

 private:
  friend class PickleFile;
  PickleValue(const PickleFile& file, std::uint32_t index) : file_(&file), index_(index) {}
  const PickleFile* file_;
  std::uint32_t index_;
};

/// A Python pickle, protocols 0 to 5, read as data only: globals become names, calls become records of their
/// arguments, nothing is imported or run. What a caller does not ask for may be of any kind.
///
/// Memory is bounded by a multiple of the file's size and by a fixed number of values; long strings stay in
/// the file's bytes.
class PickleFile {
 public:
  /// @param bytes  the pickle, which may be followed by other bytes; must outlive the object.
  /// @param name   shown in errors.
  /// @throws Error(bad_file) naming the byte where the pickle is damaged, cut short or too large.
  PickleFile(std::span<const std::byte> bytes, std::string name);
  PickleFile(const PickleFile&) = delete;
  PickleFile& operator=(const PickleFile&) = delete;

  PickleValue root() const { return {*this, root_}; }
  const std::string& name() const { return name_; }
  /// Bytes that the pickle takes.
  std::size_t size() const { return position_; }

 private:
  friend class PickleValue;
  using Id = std::uint32_t;
  /// Far above what a model file holds (some thousands), far below what would hurt.
  static constexpr std::size_t kMostValues = 1'000'000, kMostReferences = 8'000'000, kMostMarks = 100'000;

  struct Node {
    PickleKind kind = PickleKind::none;
    double number = 0;
    std::string_view text;  // into the file or into owned_; a global's name
    std::string_view module;
    Id callable = 0, arguments = 0, state = 0;  // of objects; state also of persistent values
    std::vector<Id> items;                      // of lists; of dictionaries key, value, key, value ...
    std::vector<Id> appended;                   // to an object
  };

  [[noreturn]] void fail(const std::string& what) const;
  std::string_view take(std::size_t count);
  template <typename T>
  T take_number(bool big_endian = false);
  std::string_view take_counted(std::uint64_t count);
  std::string_view take_line();

  Id add(Node node);
  Id add_number(PickleKind kind, double number);
  Id add_text(PickleKind kind, std::string_view text);
  Id add_object(Id callable, Id arguments);
  std::string_view keep(std::string text);

  void push(Id id) { stack_.push_back(id); }
  Id pop();
  Id top() const;
  std::vector<Id> pop_to_mark();
  void put_items(std::vector<Id> items, bool pairs);
  void remember(std::uint64_t key);
  void recall(std::uint64_t key);

  bool run(unsigned char opcode);
  bool run_number(unsigned char opcode);
  bool run_text(unsigned char opcode);
  bool run_container(unsigned char opcode);
  bool run_memo(unsigned char opcode);
  bool run_object(unsigned char opcode);

  std::span<const std::byte> bytes_;
  std::string name_;
  std::size_t position_ = 0;
  std::deque<Node> nodes_;
  std::deque<std::string> owned_;
  std::size_t references_ = 0;
  std::vector<Id> stack_;
  std::vector<std::size_t> marks_;
  std::unordered_map<std::uint64_t, Id> memo_;
  bool stopped_ = false;
  Id root_ = 0;
};

}  // namespace vitruvian
