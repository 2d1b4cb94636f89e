"""NAOqi's wire protocol, the same for both sides of a connection.

types, inference    what a signature such as ``(s[f])`` means, which one a Python value has
encoding, decoding  values to bytes and back; whatever the bytes are, BadFrame is the worst
frames, line        messages of 28 bytes of header and values; the socket they go over
metaobject          what an object says it can do; which overload takes which values
service, bound      a class of ours that can be called; what answers its calls
remote, hearing     an object of the other side; its events
promise, turns      results that come later; the threads that call what programs gave
peer, trade         one connection with everything that goes over it; objects within messages

Written from the measured protocol; the official package ``qi`` judges it in the tests, both ways.
"""
