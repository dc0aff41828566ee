"""What --fit asks for."""
import re

from .problem import Coupling
from .refusal import Refusal, in_quotes, listed

TERMS = {'viscous': ('damping',), 'dry': ('coulomb',), 'friction': ('damping', 'coulomb'),
         'offset': ('offset',), 'rotor': ('rotor_inertia',)}


class Wanted:
    def __init__(self, text):
        self.terms = []  # kinds of parameters of joints
        self.couplings = []  # texts
        self.payload = None  # link
        self.base = self.gain = False
        for word in text.split(','):
            self._add(word.strip())

    def _add(self, word):
        kind, _, value = word.partition(':')
        if word in TERMS:
            self.terms += [term for term in TERMS[word] if term not in self.terms]
        elif kind == 'coupled' and value:
            self.couplings.append(value)
        elif kind == 'payload' and value and not self.payload:
            self.payload = value
        elif word in ('base', 'gain'):
            setattr(self, word, True)
        elif kind == 'payload' and value:
            raise Refusal('--fit: payload is given twice')
        else:
            raise Refusal('--fit: %s is none of friction, viscous, dry, offset, rotor, coupled:A+B, '
                          'payload:LINK, base, gain' % in_quotes(word))

    def check(self, scene, unloaded, masses_known):
        """Refuses what no recording can tell."""
        if self.payload and self.base and not unloaded:
            raise Refusal('--fit: a payload cannot be told from the link that carries it: base and payload '
                          'need a recording without it, --unloaded FILE')
        if not self.gain:
            return
        known_payload = bool(scene.get('payload')) and bool(unloaded) and not self.payload
        if (self.base or not masses_known) and not known_payload:
            raise Refusal('--fit gain: efforts in unknown units tell no masses: either the masses of the '
                          'description are exact (--masses-known, without base), or the scene has a payload '
                          'that is known, with --unloaded FILE for the robot without it')
        if self.payload:
            raise Refusal('--fit: gain and payload cannot be told from each other; fit them one after the other')

    def coupled(self, coordinates):
        result = []
        for text in self.couplings:
            match = next((Coupling(text[:i], text[i + 1:], 1 if text[i] == '+' else -1)
                          for i in [m.start() for m in re.finditer(r'[+-]', text)]
                          if text[:i] in coordinates and text[i + 1:] in coordinates), None)
            if match is None:
                raise Refusal('--fit: coupled:%s is not two joints with + or - between them; the joints are %s'
                              % (text, listed(coordinates)))
            result.append(match)
        return result
