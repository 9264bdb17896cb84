#include "io/pickle.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/binary.h"
#include "io/pickle_text.h"

namespace vitruvian {
namespace {

/// Far above what a model file holds (some thousands), far below what would hurt.
constexpr std::size_t kMostValues = 1'000'000, kMostReferences = 8'000'000, kMostMarks = 100'000;
constexpr int kNewestProtocol = 5;

/// Two's complement, little-endian, any length.
double long_number(std::string_view digits) {
  double value = 0;
  for (std::size_t k = digits.size(); k-- > 0;) value = 256 * value + static_cast<unsigned char>(digits[k]);
  const bool negative = !digits.empty() && (static_cast<unsigned char>(digits.back()) & 0x80) != 0;
  return negative ? value - std::ldexp(1.0, static_cast<int>(8 * digits.size())) : value;
}

}  // namespace

PickleKind PickleValue::kind() const { return file_->nodes_[index_].kind; }

std::optional<double> PickleValue::number() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind != PickleKind::boolean && node.kind != PickleKind::integer && node.kind != PickleKind::real)
    return std::nullopt;
  return node.number;
}

std::string_view PickleValue::text() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  return node.kind == PickleKind::text || node.kind == PickleKind::bytes ? node.text : std::string_view();
}

std::size_t PickleValue::size() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind == PickleKind::object) return node.appended.size();
  return node.kind == PickleKind::list ? node.items.size() : 0;
}

PickleValue PickleValue::at(std::size_t index) const {
  const PickleFile::Node& node = file_->nodes_[index_];
  return {*file_, node.kind == PickleKind::object ? node.appended[index] : node.items[index]};
}

std::optional<PickleValue> PickleValue::find(std::string_view key) const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind != PickleKind::dictionary && node.kind != PickleKind::object) return std::nullopt;
  // Of keys that come twice Python keeps the last.
  for (std::size_t k = node.items.size(); k >= 2; k -= 2) {
    const PickleFile::Node& name = file_->nodes_[node.items[k - 2]];
    if ((name.kind == PickleKind::text || name.kind == PickleKind::bytes) && name.text == key)
      return PickleValue(*file_, node.items[k - 1]);
  }
  if (node.kind != PickleKind::object) return std::nullopt;
  const PickleValue kept = state();
  if (kept.kind() == PickleKind::dictionary) return kept.find(key);
  // Objects with slots keep a pair of dictionaries.
  for (std::size_t k = 0; kept.kind() == PickleKind::list && k < std::min<std::size_t>(2, kept.size()); ++k) {
    if (kept.at(k).kind() != PickleKind::dictionary) continue;
    if (const auto found = kept.at(k).find(key)) return found;
  }
  return std::nullopt;
}

std::vector<std::string> PickleValue::keys() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  std::vector<std::string> names;
  if (node.kind != PickleKind::dictionary && node.kind != PickleKind::object) return names;
  for (std::size_t k = 0; k + 1 < node.items.size(); k += 2) {
    const PickleFile::Node& name = file_->nodes_[node.items[k]];
    if (name.kind == PickleKind::text || name.kind == PickleKind::bytes) names.emplace_back(name.text);
  }
  return names;
}

std::string PickleValue::class_name() const {
  const PickleFile::Node& node = file_->nodes_[index_];
  if (node.kind == PickleKind::global) return std::string(node.module) + "." + std::string(node.text);
  if (node.kind != PickleKind::object) return {};
  const PickleFile::Node& callable = file_->nodes_[node.callable];
  if (callable.kind != PickleKind::global) return {};
  // How old protocols say "an empty object of this class".
  if (callable.text == "_reconstructor" || callable.text == "__newobj__" ||
      callable.text == "__newobj_ex__") {
    const PickleFile::Node& given = file_->nodes_[node.arguments];
    if (given.kind == PickleKind::list && !given.items.empty()) {
      const PickleValue first(*file_, given.items[0]);
      if (first.kind() == PickleKind::global) return first.class_name();
    }
  }
  return std::string(callable.module) + "." + std::string(callable.text);
}

PickleValue PickleValue::arguments() const { return {*file_, file_->nodes_[index_].arguments}; }
PickleValue PickleValue::state() const { return {*file_, file_->nodes_[index_].state}; }

PickleFile::PickleFile(std::span<const std::byte> bytes, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  add({});  // 0: none, what absent parts refer to
  while (!stopped_) {
    const auto opcode = static_cast<unsigned char>(take(1)[0]);
    if (!run(opcode)) {
      --position_;
      fail("is no pickle instruction (" + std::to_string(opcode) + ")");
    }
  }
}

void PickleFile::fail(const std::string& what) const {
  throw Error(ErrorCode::bad_file, name_ + ": pickle, byte " + std::to_string(position_) + ": " + what);
}

std::string_view PickleFile::take(std::size_t count) {
  if (count > bytes_.size() - position_) fail("the file is cut short");
  const std::string_view taken(reinterpret_cast<const char*>(bytes_.data()) + position_, count);
  position_ += count;
  return taken;
}

template <typename T>
T PickleFile::take_number(bool big_endian) {
  return load<T>(reinterpret_cast<const std::byte*>(take(sizeof(T)).data()), big_endian);
}

std::string_view PickleFile::take_counted(std::uint64_t count) {
  if (count > bytes_.size() - position_) fail("a string is longer than the file");
  return take(static_cast<std::size_t>(count));
}

std::string_view PickleFile::take_line() {
  const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()) + position_,
                              bytes_.size() - position_);
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos) fail("a line has no end");
  position_ += end + 1;
  return rest.substr(0, end);
}

PickleFile::Id PickleFile::add(Node node) {
  if (nodes_.size() >= kMostValues) fail("there are more values than a model file has");
  nodes_.push_back(std::move(node));
  return static_cast<Id>(nodes_.size() - 1);
}

PickleFile::Id PickleFile::add_number(PickleKind kind, double number) {
  Node node;
  node.kind = kind;
  node.number = number;
  return add(std::move(node));
}

PickleFile::Id PickleFile::add_text(PickleKind kind, std::string_view text) {
  Node node;
  node.kind = kind;
  node.text = text;
  return add(std::move(node));
}

PickleFile::Id PickleFile::add_object(Id callable, Id arguments) {
  Node node;
  node.kind = PickleKind::object;
  node.callable = callable;
  node.arguments = arguments;
  return add(std::move(node));
}

std::string_view PickleFile::keep(std::string text) {
  owned_.push_back(std::move(text));
  return owned_.back();
}

PickleFile::Id PickleFile::pop() {
  const Id id = top();
  stack_.pop_back();
  return id;
}

PickleFile::Id PickleFile::top() const {
  if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) fail("an instruction finds nothing to work on");
  return stack_.back();
}

std::vector<PickleFile::Id> PickleFile::pop_to_mark() {
  if (marks_.empty()) fail("an instruction finds no mark");
  std::vector<Id> items(stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back()), stack_.end());
  stack_.resize(marks_.back());
  marks_.pop_back();
  return items;
}

void PickleFile::put_items(std::vector<Id> items, bool pairs) {
  if (pairs && items.size() % 2 != 0) fail("a dictionary has a key without a value");
  references_ += items.size();
  if (references_ > kMostReferences) fail("there are more values than a model file has");
  Node& target = nodes_[top()];
  if (pairs ? target.kind != PickleKind::dictionary && target.kind != PickleKind::object
            : target.kind != PickleKind::list && target.kind != PickleKind::object) {
    fail("elements are added to something that holds none");
  }
  std::vector<Id>& list = !pairs && target.kind == PickleKind::object ? target.appended : target.items;
  list.insert(list.end(), items.begin(), items.end());
}

void PickleFile::remember(std::uint64_t key) {
  if (memo_.size() >= kMostValues) fail("there are more values than a model file has");
  memo_[key] = top();
}

void PickleFile::recall(std::uint64_t key) {
  const auto found = memo_.find(key);
  if (found == memo_.end()) fail("a value is referred to that was never stored");
  push(found->second);
}

bool PickleFile::run(unsigned char opcode) {
  if (stack_.size() > kMostReferences) fail("there are more values than a model file has");
  switch (opcode) {
    case 0x80:  // PROTO
      if (const int protocol = take_number<std::uint8_t>(); protocol > kNewestProtocol) {
        throw Error(ErrorCode::unsupported_format,
                    name_ + ": pickle protocol " + std::to_string(protocol) +
                        " is newer than 5; save it again with pickle.dump(..., protocol=4)");
      }
      return true;
    case 0x95:  // FRAME: only a hint for readers of streams
      if (take_number<std::uint64_t>() > bytes_.size() - position_) fail("the file is cut short");
      return true;
    case '.':
      root_ = pop();
      stopped_ = true;
      return true;
    case '(':
      if (marks_.size() >= kMostMarks) fail("values are nested too deeply");
      marks_.push_back(stack_.size());
      return true;
    case '0':
      if (!marks_.empty() && stack_.size() == marks_.back()) {
        marks_.pop_back();
      } else {
        pop();
      }
      return true;
    case '1':
      pop_to_mark();
      return true;
    case '2':
      push(top());
      return true;
    default:
      return run_number(opcode) || run_text(opcode) || run_container(opcode) || run_memo(opcode) ||
             run_object(opcode);
  }
}

bool PickleFile::run_container(unsigned char opcode) {
  const auto add_items = [&](PickleKind kind, std::vector<Id> items) {
    references_ += items.size();
    if (references_ > kMostReferences) fail("there are more values than a model file has");
    if (kind == PickleKind::dictionary && items.size() % 2 != 0)
      fail("a dictionary has a key without a value");
    Node node;
    node.kind = kind;
    node.items = std::move(items);
    push(add(std::move(node)));
  };
  const auto tuple_of = [&](std::size_t count) {
    std::vector<Id> items(count);
    for (std::size_t k = count; k-- > 0;) items[k] = pop();
    add_items(PickleKind::list, std::move(items));
  };
  switch (opcode) {
    case ')':   // EMPTY_TUPLE
    case ']':   // EMPTY_LIST
    case 0x8f:  // EMPTY_SET
      add_items(PickleKind::list, {});
      return true;
    case '}':
      add_items(PickleKind::dictionary, {});
      return true;
    case 't':   // TUPLE
    case 'l':   // LIST
    case 0x91:  // FROZENSET
      add_items(PickleKind::list, pop_to_mark());
      return true;
    case 'd':
      add_items(PickleKind::dictionary, pop_to_mark());
      return true;
    case 0x85:
      tuple_of(1);
      return true;
    case 0x86:
      tuple_of(2);
      return true;
    case 0x87:
      tuple_of(3);
      return true;
    case 'a': {  // APPEND
      const Id item = pop();
      put_items({item}, false);
      return true;
    }
    case 'e':   // APPENDS
    case 0x90:  // ADDITEMS
      put_items(pop_to_mark(), false);
      return true;
    case 's': {  // SETITEM
      const Id value = pop(), key = pop();
      put_items({key, value}, true);
      return true;
    }
    case 'u':
      put_items(pop_to_mark(), true);
      return true;
    default:
      return false;
  }
}

bool PickleFile::run_object(unsigned char opcode) {
  const auto persistent = [&](Id identifier) {
    Node node;
    node.kind = PickleKind::persistent;
    node.state = identifier;
    push(add(std::move(node)));
  };
  const auto global = [&](std::string_view module, std::string_view name) {
    Node node;
    node.kind = PickleKind::global;
    node.module = module;
    node.text = name;
    return add(std::move(node));
  };
  const auto list_of = [&](std::vector<Id> items) {
    Node node;
    node.kind = PickleKind::list;
    node.items = std::move(items);
    return add(std::move(node));
  };
  switch (opcode) {
    case 'c': {  // GLOBAL
      const std::string_view module = take_line();
      push(global(module, take_line()));
      return true;
    }
    case 0x93: {  // STACK_GLOBAL
      const Id name = pop(), module = pop();
      if (nodes_[name].kind != PickleKind::text || nodes_[module].kind != PickleKind::text)
        fail("a class has no name");
      push(global(nodes_[module].text, nodes_[name].text));
      return true;
    }
    case 0x82:  // EXT1, EXT2, EXT4: names that only one program knows
      push(global("extension", keep(std::to_string(take_number<std::uint8_t>()))));
      return true;
    case 0x83:
      push(global("extension", keep(std::to_string(take_number<std::uint16_t>()))));
      return true;
    case 0x84:
      push(global("extension", keep(std::to_string(take_number<std::uint32_t>()))));
      return true;
    case 'R':     // REDUCE
    case 0x81: {  // NEWOBJ
      const Id arguments = pop(), callable = pop();
      push(add_object(callable, arguments));
      return true;
    }
    case 0x92: {  // NEWOBJ_EX
      pop();      // keyword arguments
      const Id arguments = pop(), callable = pop();
      push(add_object(callable, arguments));
      return true;
    }
    case 'o': {  // OBJ
      std::vector<Id> items = pop_to_mark();
      if (items.empty()) fail("an object has no class");
      const Id callable = items.front();
      items.erase(items.begin());
      const Id arguments = list_of(std::move(items));
      push(add_object(callable, arguments));
      return true;
    }
    case 'i': {  // INST
      const std::string_view module = take_line();
      const Id callable = global(module, take_line());
      const Id arguments = list_of(pop_to_mark());
      push(add_object(callable, arguments));
      return true;
    }
    case 'b': {  // BUILD
      const Id state = pop();
      Node& target = nodes_[top()];
      if (target.kind == PickleKind::object) target.state = state;
      return true;
    }
    case 'P':
      persistent(add_text(PickleKind::text, take_line()));
      return true;
    case 'Q':
      persistent(pop());
      return true;
    case 0x97: {  // NEXT_BUFFER: bytes that were stored somewhere else
      Node node;
      node.kind = PickleKind::persistent;
      push(add(std::move(node)));
      return true;
    }
    case 0x98:  // READONLY_BUFFER
      top();
      return true;
    default:
      return false;
  }
}

bool PickleFile::run_number(unsigned char opcode) {
  const auto integer = [&](double value) { push(add_number(PickleKind::integer, value)); };
  switch (opcode) {
    case 'N':
      push(0);
      return true;
    case 0x88:
      push(add_number(PickleKind::boolean, 1));
      return true;
    case 0x89:
      push(add_number(PickleKind::boolean, 0));
      return true;
    case 'J':
      integer(take_number<std::int32_t>());
      return true;
    case 'K':
      integer(take_number<std::uint8_t>());
      return true;
    case 'M':
      integer(take_number<std::uint16_t>());
      return true;
    case 0x8a:  // LONG1
      integer(long_number(take(take_number<std::uint8_t>())));
      return true;
    case 0x8b: {  // LONG4
      const auto count = take_number<std::int32_t>();
      if (count < 0) fail("a number has a negative length");
      integer(long_number(take_counted(static_cast<std::uint64_t>(count))));
      return true;
    }
    case 'G':
      push(add_number(PickleKind::real, take_number<double>(true)));
      return true;
    case 'I':  // INT, LONG, FLOAT
    case 'L':
    case 'F': {
      std::string_view line = take_line();
      if (opcode == 'I' && (line == "00" || line == "01")) {
        push(add_number(PickleKind::boolean, line == "01"));
        return true;
      }
      if (opcode == 'L' && !line.empty() && line.back() == 'L') line.remove_suffix(1);
      const std::optional<double> value = parse_text_number(line);
      if (!value) fail("a number cannot be read");
      push(add_number(opcode == 'F' ? PickleKind::real : PickleKind::integer, *value));
      return true;
    }
    default:
      return false;
  }
}

bool PickleFile::run_memo(unsigned char opcode) {
  const auto key = [&]() -> std::uint64_t {
    const std::optional<double> value = parse_text_number(take_line());
    if (!value || !(*value >= 0 && *value < 1e15)) fail("a stored value has no number");
    return static_cast<std::uint64_t>(*value);
  };
  switch (opcode) {
    case 'p':
      remember(key());
      return true;
    case 'q':
      remember(take_number<std::uint8_t>());
      return true;
    case 'r':
      remember(take_number<std::uint32_t>());
      return true;
    case 0x94:
      remember(memo_.size());
      return true;
    case 'g':
      recall(key());
      return true;
    case 'h':
      recall(take_number<std::uint8_t>());
      return true;
    case 'j':
      recall(take_number<std::uint32_t>());
      return true;
    default:
      return false;
  }
}

bool PickleFile::run_text(unsigned char opcode) {
  const auto text = [&](std::string_view content) { push(add_text(PickleKind::text, content)); };
  const auto bytes = [&](std::string_view content) { push(add_text(PickleKind::bytes, content)); };
  switch (opcode) {
    case 'X':  // BINUNICODE
      text(take_counted(take_number<std::uint32_t>()));
      return true;
    case 0x8c:
      text(take(take_number<std::uint8_t>()));
      return true;
    case 0x8d:
      text(take_counted(take_number<std::uint64_t>()));
      return true;
    case 'T': {  // BINSTRING
      const auto count = take_number<std::int32_t>();
      if (count < 0) fail("a string has a negative length");
      text(take_counted(static_cast<std::uint64_t>(count)));
      return true;
    }
    case 'U':
      text(take(take_number<std::uint8_t>()));
      return true;
    case 'B':
      bytes(take_counted(take_number<std::uint32_t>()));
      return true;
    case 'C':
      bytes(take(take_number<std::uint8_t>()));
      return true;
    case 0x8e:  // BINBYTES8, BYTEARRAY8
    case 0x96:
      bytes(take_counted(take_number<std::uint64_t>()));
      return true;
    case 'S': {  // STRING: a Python literal in quotes
      std::string_view line = take_line();
      if (line.size() < 2 || (line[0] != '\'' && line[0] != '"') || line.back() != line[0])
        fail("a string has no quotes");
      text(keep(unescaped_string(line.substr(1, line.size() - 2))));
      return true;
    }
    case 'V':  // UNICODE: raw-unicode-escape
      text(keep(unescaped_unicode(take_line())));
      return true;
    default:
      return false;
  }
}

}  // namespace vitruvian
