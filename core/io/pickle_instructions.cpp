// What each instruction of a pickle does (Python's pickletools names them).
#include <cmath>

#include "base/error.h"
#include "io/binary.h"
#include "io/pickle.h"
#include "io/pickle_text.h"

namespace vitruvian {
namespace {

constexpr int kNewestProtocol = 5;

/// Two's complement, little-endian, any length.
double long_number(std::string_view digits) {
  double value = 0;
  for (std::size_t k = digits.size(); k-- > 0;) value = 256 * value + static_cast<unsigned char>(digits[k]);
  const bool negative = !digits.empty() && (static_cast<unsigned char>(digits.back()) & 0x80) != 0;
  return negative ? value - std::ldexp(1.0, static_cast<int>(8 * digits.size())) : value;
}

}  // namespace

template <typename T>
T PickleFile::take_number(bool big_endian) {
  return load<T>(reinterpret_cast<const std::byte*>(take(sizeof(T)).data()), big_endian);
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
