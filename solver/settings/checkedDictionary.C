// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/checkedDictionary.H"

#include "settings/foamExceptions.H"

#include "IFstream.H"
#include "OSspecific.H"
#include "OStringStream.H"
#include "Pstream.H"
#include "StringStream.H"
#include "Switch.H"
#include "Tuple2.H"
#include "scalarList.H"
#include "vector.H"
#include "wordList.H"

#include <algorithm>
#include <cfenv>
#include <fstream>
#include <sstream>

namespace him {

namespace {

/// The text of a file as the master rank sees it; nothing when there is no such file. Collective.
std::optional<Foam::string> textOf(const Foam::fileName& path)
{
    bool exists = false;
    Foam::string text;
    if (Foam::Pstream::master()) {
        exists = Foam::isFile(path, false);
        std::ifstream stream(path);
        std::ostringstream all;
        all << stream.rdbuf();
        text = all.str();
    }
    Foam::Pstream::scatter(exists);
    Foam::Pstream::scatter(text);
    if (!exists) {
        return {};
    }
    return text;
}

/// Floating-point traps are off while this lives: the C library's reader of numbers overflows on 1e400, which must become a complaint.
class withoutTraps {
public:
    withoutTraps() { std::feholdexcept(&before_); }
    ~withoutTraps() { std::fesetenv(&before_); }
    withoutTraps(const withoutTraps&) = delete;
    withoutTraps& operator=(const withoutTraps&) = delete;

private:
    std::fenv_t before_;
};

/// Reads `value` or `value (lower upper)`.
Foam::Istream& operator>>(Foam::Istream& stream, ValueWithEnds& number)
{
    Foam::scalar value = 0;
    stream >> value;
    number = {value, value, value};
    if (!stream.eof() && static_cast<Foam::ITstream&>(stream).nRemainingTokens()) {
        Foam::scalarList ends;
        stream >> ends;
        if (ends.size() != 2) {
            FatalIOErrorInFunction(stream) << "two ends are expected" << Foam::exit(Foam::FatalIOError);
        }
        number.lower = ends[0];
        number.upper = ends[1];
    }
    return stream;
}

}  // namespace

std::string joined(const std::vector<std::string>& words)
{
    std::string all;
    for (const std::string& word : words) {
        all += (all.empty() ? "" : ", ") + word;
    }
    return all;
}

checkedDictionary::checkedDictionary(const Foam::fileName& casePath, const Foam::fileName& file, Complaints& complaints)
    : where_(file), readable_(false), complaints_(complaints)
{
    const std::optional<Foam::string> text = textOf(casePath / file);
    if (!text) {
        complaints.add(where_, "there is no such file in the case " + casePath + ".");
        return;
    }
    const foamExceptions throwing;
    const withoutTraps tooLargeNumbers;
    try {
        Foam::IStringStream stream(*text, Foam::IOstream::ASCII, Foam::IOstream::currentVersion, casePath / file);
        contents_ = Foam::dictionary(stream);
        contents_.remove("FoamFile");
        readable_ = true;
    } catch (const Foam::error& error) {
        complaints.add(where_, "cannot be parsed: " + firstLine(error));
    }
}

bool checkedDictionary::exists(const Foam::fileName& casePath, const Foam::fileName& file)
{
    bool found = Foam::Pstream::master() && Foam::isFile(casePath / file, false);
    Foam::Pstream::scatter(found);
    return found;
}

checkedDictionary::checkedDictionary(const Foam::dictionary& contents, const std::string& where, bool readable,
                                     Complaints& complaints)
    : contents_(contents), where_(where), readable_(readable), complaints_(complaints)
{
}

void checkedDictionary::complain(const std::string& entry, const std::string& what) const
{
    complaints_.get().add(where_ + ": " + entry, what);
}

void checkedDictionary::know(const std::string& entry)
{
    if (std::find(known_.begin(), known_.end(), entry) == known_.end()) {
        known_.push_back(entry);
    }
}

bool checkedDictionary::absent(const std::string& entry, bool required, const std::string& remedy)
{
    know(entry);
    if (contents_.found(entry)) {
        return false;
    }
    if (required && readable_) {
        complain(entry, "the entry is missing." + (remedy.empty() ? "" : " " + remedy));
    }
    return true;
}

std::string checkedDictionary::wordsOf(const std::string& entry) const
{
    Foam::OStringStream stream;
    bool first = true;
    for (const Foam::token& token : contents_.findEntry(entry)->stream()) {
        stream << (first ? "" : " ") << token;
        first = false;
    }
    return stream.str();
}

std::string checkedDictionary::found(const std::string& entry) const
{
    return contents_.findEntry(entry)->isDict() ? "a sub-dictionary" : "`" + wordsOf(entry) + "`";
}

template <class Value>
bool checkedDictionary::read(const std::string& entry, const std::string& expected, Value& value) const
{
    const Foam::entry* found = contents_.findEntry(entry);
    if (found->isStream()) {
        const foamExceptions throwing;
        try {
            Foam::ITstream& stream = found->stream();
            stream >> value;
            if (!stream.nRemainingTokens()) {
                return true;
            }
        } catch (const Foam::error&) {
            // The complaint below says all there is to say.
        }
    }
    complain(entry, "found " + this->found(entry) + ", but " + expected + " is expected.");
    return false;
}

bool checkedDictionary::has(const std::string& entry)
{
    return !absent(entry, false);
}

double checkedDictionary::number(const std::string& entry, std::optional<double> defaultValue)
{
    double value = defaultValue.value_or(0);
    if (!absent(entry, !defaultValue)) {
        read(entry, "a number", value);
    }
    return value;
}

double checkedDictionary::positive(const std::string& entry, std::optional<double> defaultValue)
{
    const double harmless = defaultValue.value_or(1);
    double value = harmless;
    if (absent(entry, !defaultValue) || !read(entry, "a number above zero", value)) {
        return harmless;
    }
    if (!(value > 0)) {
        complain(entry, "found " + shown(value) + ", but a number above zero is expected.");
        return harmless;
    }
    return value;
}

long checkedDictionary::integerFrom(const std::string& entry, long smallest, long defaultValue)
{
    const std::string expected = "a whole number from " + std::to_string(smallest) + " upwards";
    Foam::label value = static_cast<Foam::label>(defaultValue);
    if (absent(entry, false) || !read(entry, expected, value)) {
        return defaultValue;
    }
    if (value < smallest) {
        complain(entry, "found " + std::to_string(value) + ", but " + expected + " is expected.");
        return defaultValue;
    }
    return value;
}

long checkedDictionary::positiveInteger(const std::string& entry, long defaultValue)
{
    return integerFrom(entry, 1, defaultValue);
}

long checkedDictionary::nonNegativeInteger(const std::string& entry, long defaultValue)
{
    return integerFrom(entry, 0, defaultValue);
}

Vector3 checkedDictionary::vector(const std::string& entry, const Vector3& defaultValue)
{
    Foam::vector value(defaultValue.x(), defaultValue.y(), defaultValue.z());
    if (absent(entry, false) || !read(entry, "a vector like (0 0 1e5)", value)) {
        return defaultValue;
    }
    return {value.x(), value.y(), value.z()};
}

bool checkedDictionary::yesNo(const std::string& entry, bool defaultValue)
{
    Foam::Switch value(defaultValue);
    if (absent(entry, false) || !read(entry, "yes or no", value)) {
        return defaultValue;
    }
    return bool(value);
}

std::string checkedDictionary::text(const std::string& entry)
{
    Foam::string value;
    if (!absent(entry, true)) {
        read(entry, "text in double quotes", value);
    }
    return value;
}

std::string checkedDictionary::written(const std::string& entry)
{
    return absent(entry, false) || contents_.findEntry(entry)->isDict() ? "" : wordsOf(entry);
}

std::string checkedDictionary::oneOf(const std::string& entry, const std::vector<std::string>& known,
                                     const std::string& defaultValue)
{
    Foam::word value;
    if (absent(entry, defaultValue.empty(), "Write one of: " + joined(known) + ".")
        || !read(entry, "one of " + joined(known), value)) {
        return defaultValue;
    }
    if (std::find(known.begin(), known.end(), value) == known.end()) {
        complain(entry, "unknown name `" + value + "`; known: " + joined(known) + ".");
        return defaultValue;
    }
    return value;
}

checkedDictionary checkedDictionary::section(const std::string& entry, bool optional)
{
    const std::string where = where_ + ": " + entry;
    if (absent(entry, !optional)) {
        return {Foam::dictionary(), where, false, complaints_};
    }
    const Foam::dictionary* contents = contents_.findDict(entry);
    if (!contents) {
        complain(entry, "found " + found(entry) + ", but a sub-dictionary { ... } is expected.");
        return {Foam::dictionary(), where, false, complaints_};
    }
    return {*contents, where, true, complaints_};
}

std::vector<std::string> checkedDictionary::sectionsWith(const std::string& entry) const
{
    std::vector<std::string> names;
    for (const Foam::entry& candidate : contents_) {
        if (candidate.isDict() && candidate.dict().found(entry)) {
            names.push_back(candidate.keyword());
        }
    }
    return names;
}

std::vector<std::string> checkedDictionary::sections() const
{
    std::vector<std::string> names;
    for (const Foam::entry& candidate : contents_) {
        if (candidate.isDict()) {
            names.push_back(candidate.keyword());
        }
    }
    return names;
}

std::optional<ValueWithEnds> checkedDictionary::valueWithEnds(const std::string& entry, bool required)
{
    ValueWithEnds value;
    if (absent(entry, required) || !read(entry, "a number, or a number and its interval like 5 (4 6),", value)) {
        return {};
    }
    return value;
}

std::vector<double> checkedDictionary::numbers(const std::string& entry)
{
    Foam::scalarList list;
    if (absent(entry, false) || !read(entry, "a list of numbers like (1 2)", list)) {
        return {};
    }
    return {list.begin(), list.end()};
}

std::vector<std::pair<double, double>> checkedDictionary::pairs(const std::string& entry)
{
    Foam::List<Foam::Tuple2<Foam::scalar, Foam::scalar>> list;
    std::vector<std::pair<double, double>> all;
    if (!absent(entry, false) && read(entry, "a list of pairs like ((0 0) (2 -1e-10))", list)) {
        for (const Foam::Tuple2<Foam::scalar, Foam::scalar>& pair : list) {
            all.emplace_back(pair.first(), pair.second());
        }
    }
    return all;
}

std::vector<std::string> checkedDictionary::names(const std::string& entry)
{
    Foam::wordList list;
    if (absent(entry, false) || !read(entry, "a list of names like (small large)", list)) {
        return {};
    }
    return {list.begin(), list.end()};
}

std::vector<std::pair<std::string, std::string>> checkedDictionary::words()
{
    std::vector<std::pair<std::string, std::string>> all;
    for (const Foam::word& entry : contents_.toc()) {
        know(entry);
        Foam::word value;
        if (read(entry, "one word", value)) {
            all.emplace_back(entry, value);
        }
    }
    return all;
}

void checkedDictionary::refuseUnknownEntries() const
{
    for (const Foam::word& entry : contents_.toc()) {
        if (std::find(known_.begin(), known_.end(), entry) == known_.end()) {
            complain(entry, "unknown entry; known: " + joined(known_) + ".");
        }
    }
}

}  // namespace him
