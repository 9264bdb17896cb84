#include "io/pickle.h"

#include "base/error.h"

namespace vitruvian {

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

}  // namespace vitruvian
