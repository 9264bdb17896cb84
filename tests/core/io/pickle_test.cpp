#include "io/pickle.h"

#include "base/random.h"
#include "core/io/test_files.h"
#include "io/pickle_arrays.h"

namespace vitruvian::test {
namespace {

using namespace std::string_literals;

NumericArray array_of(const std::string& bytes) {
  const PickleFile file(as_bytes(bytes), "a.pkl");
  return numeric_array(file.root(), "a.pkl");
}

Error pickle_error(const std::string& bytes, bool as_array = true) {
  try {
    const PickleFile file(as_bytes(bytes), "a.pkl");
    if (as_array) numeric_array(file.root(), "a.pkl");
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return Error(ErrorCode::internal, "no error");
}

/// numpy.array([[1, 2, 3], [4, 5, 6]], dtype) as protocol 2 of Python 2 keeps it.
std::string array_pickle(const std::string& type, const std::string& order, bool fortran,
                         const std::string& raw, const std::string& shape = "K\x02K\x03\x86"s) {
  std::string bytes = "\x80\x02"s + "cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n";
  bytes += "K\x00\x85U\x01"s + "b\x87R(K\x01" + shape + "cnumpy\ndtype\nU\x02" + type;
  bytes += "K\x00K\x01\x87R(K\x03U\x01"s + order + "NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00tb"s;
  bytes +=
      (fortran ? "\x88" : "\x89") + "T"s + std::string{static_cast<char>(raw.size()), 0, 0, 0} + raw + "tb.";
  return bytes;
}

template <class T>
std::string raw_numbers(std::initializer_list<double> values, bool big_endian = false) {
  std::string raw;
  for (const double value : values) put(raw, static_cast<T>(value), big_endian);
  return raw;
}

TEST(Pickle, ValuesOfEveryKind) {
  const std::string bytes =
      "(dS'a\\x41\\101\\n\\\\'\nI01\nsVb\\u00e9\nF1.5e-3\nsI7\nL123456789012L\nsU\x01kJ\xfe\xff\xff\xffsU\x01l(lI1\naNas."s;
  const PickleFile file(as_bytes(bytes), "a.pkl");
  const PickleValue root = file.root();
  ASSERT_EQ(root.kind(), PickleKind::dictionary);
  EXPECT_EQ(root.keys(), (std::vector<std::string>{"aAA\n\\", "b\xc3\xa9", "k", "l"}));
  EXPECT_EQ(root.find("aAA\n\\")->kind(), PickleKind::boolean);
  EXPECT_DOUBLE_EQ(*root.find("b\xc3\xa9")->number(), 1.5e-3);
  EXPECT_DOUBLE_EQ(*root.find("k")->number(), -2);
  ASSERT_EQ(root.find("l")->size(), 2u);
  EXPECT_TRUE(root.find("l")->at(1).is_none());
  EXPECT_FALSE(root.find("m"));
}

TEST(Pickle, LongIntegersKeepTheirSign) {
  const auto value = [](const std::string& digits) {
    const std::string bytes =
        "\x80\x02\x8a"s + std::string(1, static_cast<char>(digits.size())) + digits + ".";
    const PickleFile file(as_bytes(bytes), "a.pkl");
    return *file.root().number();
  };
  EXPECT_EQ(value(""), 0);
  EXPECT_EQ(value("\xff"), -1);
  EXPECT_EQ(value("\xff\x00"s), 255);
  EXPECT_EQ(value("\x00\x80"s), -32768);
  EXPECT_EQ(value("\xff\xff\xff\xff\x00"s), 4294967295.0);
}

TEST(Pickle, NothingIsEverCalled) {
  // os.system("touch /tmp/x") and an object whose restoring would run code: both become records.
  const std::string bytes =
      "cos\nsystem\n(S'touch /tmp/vitruvian-was-here'\ntRcposix\nremove\n)\x81}S'x'\nI1\nsb\x86.";
  const PickleFile file(as_bytes(bytes), "a.pkl");
  ASSERT_EQ(file.root().size(), 2u);
  EXPECT_EQ(file.root().at(0).class_name(), "os.system");
  EXPECT_EQ(file.root().at(0).arguments().at(0).text(), "touch /tmp/vitruvian-was-here");
  EXPECT_EQ(file.root().at(1).class_name(), "posix.remove");
  EXPECT_DOUBLE_EQ(*file.root().at(1).find("x")->number(), 1);
  EXPECT_THROW(numeric_array(file.root().at(0), "a.pkl"), Error);
}

TEST(Pickle, ArraysOfEveryTypeAndOrder) {
  const std::vector<double> expected = {1, 2, 3, 4, 5, 6};
  const auto check = [&](const std::string& bytes) {
    const NumericArray array = array_of(bytes);
    EXPECT_EQ(array.shape, (std::vector<std::size_t>{2, 3}));
    EXPECT_EQ(array.values, expected);
  };
  check(array_pickle("f8", "<", false, raw_numbers<double>({1, 2, 3, 4, 5, 6})));
  check(array_pickle("f8", ">", false, raw_numbers<double>({1, 2, 3, 4, 5, 6}, true)));
  check(array_pickle("f8", "<", true, raw_numbers<double>({1, 4, 2, 5, 3, 6})));
  check(array_pickle("f4", "<", false, raw_numbers<float>({1, 2, 3, 4, 5, 6})));
  check(array_pickle("i8", "<", true, raw_numbers<std::int64_t>({1, 4, 2, 5, 3, 6})));
  check(array_pickle("u4", ">", false, raw_numbers<std::uint32_t>({1, 2, 3, 4, 5, 6}, true)));
  check(array_pickle("i2", "<", false, raw_numbers<std::int16_t>({1, 2, 3, 4, 5, 6})));
  check(array_pickle("u1", "|", false, raw_numbers<std::uint8_t>({1, 2, 3, 4, 5, 6})));
}

TEST(Pickle, ArraysWhoseShapeDoesNotFitAreRefused) {
  const std::string raw = raw_numbers<double>({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(pickle_error(array_pickle("f8", "<", false, raw, "K\x02K\x04\x86"s)).code(), ErrorCode::bad_file);
  EXPECT_EQ(pickle_error(array_pickle("f8", "<", false, raw, "K\x02J\xff\xff\xff\xff\x86"s)).code(),
            ErrorCode::bad_file);
  // 2^16 x 2^16 x 2^16 x 2^16 elements: the product does not fit into 64 bits.
  const std::string huge = "(J\x00\x00\x01\x00J\x00\x00\x01\x00J\x00\x00\x01\x00J\x00\x00\x01\x00t"s;
  EXPECT_EQ(pickle_error(array_pickle("f8", "<", false, raw, huge)).code(), ErrorCode::bad_file);
  EXPECT_EQ(pickle_error(array_pickle("O8", "|", false, raw)).code(), ErrorCode::unsupported_format);
  EXPECT_EQ(pickle_error(array_pickle("c8", "<", false, raw)).code(), ErrorCode::unsupported_format);
}

TEST(Pickle, BytesSavedAsTextAreDecoded) {
  // Protocol 2 of Python 3 has no bytes: _codecs.encode('\x80\xff1', 'latin1').
  const std::string bytes =
      "c_codecs\nencode\nX\x05\x00\x00\x00\xc2\x80\xc3\xbf"s + "1X\x06\x00\x00\x00latin1\x86R."s;
  const PickleFile file(as_bytes(bytes), "a.pkl");
  EXPECT_EQ(content_of(file.root(), "a.pkl"), "\x80\xff"s + "1");
}

TEST(Pickle, SelfReferringObjectsEnd) {
  // A chumpy object whose array is itself.
  const std::string bytes = "\x80\x02"s + "cchumpy.ch\nCh\n)\x81q\x00}U\x01xh\x00sb."s;
  EXPECT_EQ(pickle_error(bytes).code(), ErrorCode::bad_file);
  // A list that holds itself.
  EXPECT_EQ(pickle_error("]q\x00h\x00"s + "a."s).code(), ErrorCode::unsupported_format);
}

TEST(Pickle, DamageIsNamedWithItsPlace) {
  const auto says = [](const std::string& bytes, const std::string& words) {
    const Error error = pickle_error(bytes, false);
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  };
  says("", "byte 0: the file is cut short");
  says("K\x01", "byte 2: the file is cut short");
  says("\x80\x02\x07.", "no pickle instruction (7)");
  says(".", "finds nothing to work on");
  says("a.", "finds nothing to work on");
  says("(0t.", "finds no mark");
  says("(K\x01K\x02u.", "finds nothing");
  says("}(K\x01u.", "a key without a value");
  says("K\x01K\x02"s + "a.", "added to something that holds none");
  says("h\x05.", "never stored");
  says("X\xff\xff\xff\xff"s, "longer than the file");
  says("\x8e\xff\xff\xff\xff\xff\xff\xff\xff."s, "longer than the file");
  says("T\xff\xff\xff\xff."s, "negative length");
  says("Fnothing\n.", "a number cannot be read");
  says("S'a\n.", "no quotes");
  says("Vabc", "a line has no end");
  says("\x95\xff\xff\xff\xff\xff\xff\xff\x7f."s, "cut short");
  says("K\x01K\x02\x93.", "a class has no name");
  says(std::string(200'000, '('), "nested too deeply");
  EXPECT_EQ(pickle_error("\x80\x06N.", false).code(), ErrorCode::unsupported_format);
}

TEST(Pickle, FloodsOfValuesAreStopped) {
  EXPECT_EQ(pickle_error(std::string(2'000'000, ']'), false).code(), ErrorCode::bad_file);
  // Doubling by appending a list's copy again and again: references are counted.
  std::string bytes = "]";
  for (int k = 0; k < 3'000'000; ++k) bytes += "2";
  bytes += "(";
  EXPECT_EQ(pickle_error(bytes, false).code(), ErrorCode::bad_file);
}

}  // namespace
}  // namespace vitruvian::test
