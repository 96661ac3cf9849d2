// bone_names.cpp  The table of words.
#include "baker/mesh/anatomy/bone_names.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

namespace sinew::baker {
namespace {

using Words = std::set<std::string_view>;

const std::map<std::string_view, SoftKind>& soft_words() {
  static const std::map<std::string_view, SoftKind> kWords = [] {
    std::map<std::string_view, SoftKind> words;
    const auto add = [&](SoftKind kind, std::initializer_list<std::string_view> list) {
      for (const std::string_view word : list) words[word] = kind;
    };
    add(SoftKind::kBelly, {"belly", "stomach", "tummy", "gut", "paunch"});
    add(SoftKind::kBreast, {"breast", "breasts", "bust", "busts", "boob", "boobs", "bosom", "pectoral"});
    add(SoftKind::kGlute, {"glute", "glutes", "gluteus", "butt", "buttock", "buttocks", "bum"});
    add(SoftKind::kCheek, {"cheek", "cheeks", "jowl", "jowls"});
    add(SoftKind::kUdder, {"udder"});
    add(SoftKind::kHump, {"hump"});
    add(SoftKind::kOther, {"dewlap", "wattle"});
    add(SoftKind::kEar, {"ear", "ears"});
    add(SoftKind::kTail, {"tail", "tails"});
    add(SoftKind::kHair,
        {"hair",      "hairs",    "ponytail", "pigtail", "twintail",  "braid",      "braids",
         "plait",     "fringe",   "bang",     "bangs",   "ahoge",     "forelock",   "sideburn",
         "sideburns", "dread",    "dreads",   "mane",    "dreadlock", "dreadlocks", "beard",
         "moustache", "mustache", "goatee",   "plume",   "lock",      "locks"});
    add(SoftKind::kTrunk, {"trunk", "proboscis"});
    add(SoftKind::kTentacle, {"tentacle", "tentacles"});
    add(SoftKind::kAntenna, {"antenna", "antennae", "antennas", "feeler", "feelers", "eyestalk", "barbel",
                             "barbels", "whisker", "whiskers"});
    add(SoftKind::kFin, {"fin", "fins", "fluke", "flukes"});
    add(SoftKind::kCloth, {"cape",    "cloak", "skirt",    "scarf",   "ribbon", "ribbons",   "tassel",
                           "tassels", "coat",  "coattail", "sash",    "veil",   "dress",     "robe",
                           "gown",    "kilt",  "tabard",   "shawl",   "apron",  "loincloth", "poncho",
                           "mantle",  "frill", "cloth",    "necktie", "banner", "flag",      "pennant"});
    return words;
  }();
  return kWords;
}

// Of meshes and materials alone: a bone of a hat is no chain, and those of feathers are a wing's.
const std::map<std::string_view, SoftKind>& piece_words() {
  static const std::map<std::string_view, SoftKind> kWords = [] {
    std::map<std::string_view, SoftKind> words;
    for (const auto& [word, kind] : soft_words())
      if (kind == SoftKind::kEar || kind == SoftKind::kTail || kind == SoftKind::kHair ||
          kind == SoftKind::kFin || kind == SoftKind::kCloth)
        words[word] = kind;
    for (const std::string_view word : {"hat", "hood", "bonnet", "beret", "beanie", "sombrero", "turban"})
      words[word] = SoftKind::kHat;
    for (const std::string_view word : {"feather", "feathers"}) words[word] = SoftKind::kFin;
    for (const std::string_view word : {"wig", "bun"}) words[word] = SoftKind::kHair;
    words["pompom"] = SoftKind::kCloth;
    return words;
  }();
  return kWords;
}

// With one of these a limb's name means the flesh on it.
const Words kFlesh = {"jiggle", "jiggles", "jiggly", "wobble", "wobbly", "flab", "flesh", "fat"};

const std::map<std::string_view, SoftKind> kFleshOf = {
    {"thigh", SoftKind::kThigh},  {"upleg", SoftKind::kThigh}, {"upperleg", SoftKind::kThigh},
    {"leg", SoftKind::kThigh},    {"hip", SoftKind::kGlute},   {"hips", SoftKind::kGlute},
    {"chest", SoftKind::kBreast}, {"pec", SoftKind::kBreast},  {"pecs", SoftKind::kBreast},
    {"face", SoftKind::kCheek}};

// What is on the head moves with its expressions, not by itself.
const Words kFace = {"head",  "skull",  "face",    "neck",    "jaw",      "chin",   "mouth",
                     "lip",   "lips",   "nose",    "snout",   "muzzle",   "tongue", "teeth",
                     "tooth", "eye",    "eyes",    "lid",     "brow",     "brows",  "eyebrow",
                     "beak",  "eyelid", "eyelids", "eyelash", "forehead", "nostril"};

const Words kBody = {"spine",    "chest",  "torso",    "pelvis",    "hip",  "hips",     "waist",
                     "clavicle", "collar", "shoulder", "scapula",   "arm",  "upperarm", "forearm",
                     "lowerarm", "elbow",  "wrist",    "hand",      "palm", "finger",   "fingers",
                     "thumb",    "index",  "pinky",    "pinkie",    "leg",  "upleg",    "upperleg",
                     "lowerleg", "thigh",  "knee",     "calf",      "shin", "ankle",    "foot",
                     "feet",     "toe",    "toes",     "heel",      "hoof", "paw",      "claw",
                     "claws",    "wing",   "wings",    "metacarpal"};

const Words kHelper = {"ik",     "fk",  "ctrl",     "ctl",    "control", "controller", "pole",
                       "target", "tgt", "end",      "twist",  "roll",    "nub",        "mch",
                       "wgt",    "aim", "effector", "facial", "tweak"};

// Hard things that are named after the part that they are on.
const Words kHard = {"armor",     "armour",  "plate",    "guard",     "metal",    "pin",       "clip",
                     "band",      "ring",    "rings",    "light",     "lights",   "gate",      "rotor",
                     "wing",      "gun",     "hook",     "lid",       "door",     "phone",     "phones",
                     "piece",     "muff",    "horn",     "spike",     "spikes",   "blade",     "sword",
                     "weapon",    "socket",  "slot",     "prop",      "buckle",   "brooch",    "earring",
                     "earrings",  "hairpin", "hairband", "headphone", "earphone", "taillight", "helmet",
                     "helm",      "crown",   "mask",     "staff",     "broom",    "wand",      "book",
                     "spellbook", "shield",  "axe",      "hammer",    "dagger",   "knife",     "spear",
                     "mace",      "arrow",   "quiver",   "handslot",  "glasses",  "goggles",   "gauntlet"};

const Words kHardBody = {"armor",    "armour", "knight",  "robot",  "mech",   "mecha", "droid", "android",
                         "skeleton", "golem",  "machine", "cyborg", "statue", "car",   "truck", "tank"};

const Words kBeside = {"left", "right", "front", "back", "side", "upper", "lower",
                       "mid",  "outer", "inner", "root", "base", "tip",   "center"};

// Meaningful only together, written apart.
const std::map<std::string_view, std::string_view> kTogether = {
    {"ponytail", "pony"},   {"pigtail", "pig"},      {"twintail", "twin"},  {"coattail", "coat"},
    {"dreadlock", "dread"}, {"dreadlocks", "dread"}, {"sideburn", "side"},  {"sideburns", "side"},
    {"forelock", "fore"},   {"forearm", "fore"},     {"upleg", "up"},       {"upperarm", "upper"},
    {"lowerarm", "lower"},  {"upperleg", "upper"},   {"lowerleg", "lower"}, {"loincloth", "loin"},
    {"earring", "ear"},     {"earrings", "ear"},     {"hairpin", "hair"},   {"hairband", "hair"},
    {"headphone", "head"},  {"earphone", "ear"},     {"taillight", "tail"}, {"eyestalk", "eye"},
    {"eyebrow", "eye"},     {"eyelid", "eye"}};

bool known(std::string_view word) {
  return piece_words().contains(word) || soft_words().contains(word) || kFlesh.contains(word) ||
         kFace.contains(word) || kBody.contains(word) || kHelper.contains(word) || kHard.contains(word);
}

// "lefttail", "tailroot": what is left without the word beside it, where that says something.
std::string stripped(const std::string& word) {
  if (known(word)) return word;
  for (const std::string_view beside : kBeside) {
    if (word.size() <= beside.size()) continue;
    const std::string after = word.substr(beside.size()),
                      before = word.substr(0, word.size() - beside.size());
    if (word.starts_with(beside) && known(after)) return after;
    if (word.ends_with(beside) && known(before)) return before;
  }
  return word;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

// Between aB, and before the last capital of ABc.
bool begins_word(const std::string& name, size_t at) {
  if (at == 0 || !is_letter(name[at - 1])) return true;
  if (!is_upper(name[at])) return false;
  const bool lower_follows = at + 1 < name.size() && is_letter(name[at + 1]) && !is_upper(name[at + 1]);
  return !is_upper(name[at - 1]) || lower_follows;
}

std::vector<std::string> joined(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string both = i + 1 < words.size() ? words[i] + words[i + 1] : "";
    const auto found = kTogether.find(both);
    const bool together = found != kTogether.end() && found->second == words[i];
    out.push_back(together ? both : words[i]);
    if (together) ++i;
  }
  return out;
}

std::optional<SoftKind> flesh_of(const std::vector<std::string>& words) {
  if (std::ranges::none_of(words, [](const auto& word) { return kFlesh.contains(word); }))
    return std::nullopt;
  for (const std::string& word : words)
    if (const auto found = kFleshOf.find(word); found != kFleshOf.end()) return found->second;
  return SoftKind::kOther;
}

// The last word's, unless something hard follows.
std::optional<SoftKind> kind_of(const std::vector<std::string>& words,
                                const std::map<std::string_view, SoftKind>& soft) {
  std::optional<SoftKind> kind;
  for (const std::string& word : words) {
    const auto found = soft.find(word);
    if (found == soft.end()) {
      if (kHard.contains(word)) kind.reset();
      continue;
    }
    const bool buttock = kind == SoftKind::kGlute && found->second == SoftKind::kCheek;
    if (!buttock) kind = found->second;
  }
  return kind;
}

}  // namespace

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  for (size_t i = 0; i < name.size(); ++i) {
    if (!is_letter(name[i])) continue;
    if (begins_word(name, i)) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  for (std::string& word : words) word = stripped(word);
  return joined(words);
}

NameMeaning meaning_of(const std::string& name) {
  const std::vector<std::string> words = words_of(name);
  const auto any_of = [&](const Words& set) {
    return std::ranges::any_of(words, [&](const std::string& word) { return set.contains(word); });
  };
  NameMeaning meaning;
  meaning.helper = any_of(kHelper);
  if (meaning.helper) return meaning;
  meaning.kind = kind_of(words, soft_words());
  meaning.piece = kind_of(words, piece_words());
  meaning.hard = !meaning.piece && any_of(kHard);
  if (!meaning.kind) meaning.kind = flesh_of(words);
  meaning.face = !meaning.kind && any_of(kFace);
  meaning.body = meaning.face || (!meaning.kind && any_of(kBody));
  return meaning;
}

bool is_hard_body(const std::string& name) {
  const std::vector<std::string> words = words_of(name);
  return std::ranges::any_of(words, [](const std::string& word) { return kHardBody.contains(word); });
}

bool swings_as_chain(SoftKind kind) {
  switch (kind) {
    case SoftKind::kEar:
    case SoftKind::kTail:
    case SoftKind::kHair:
    case SoftKind::kTrunk:
    case SoftKind::kTentacle:
    case SoftKind::kAntenna:
    case SoftKind::kFin:
    case SoftKind::kCloth:
      return true;
    default:
      return false;
  }
}

}  // namespace sinew::baker
