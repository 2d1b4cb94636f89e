x = 5
l = []
while x:
    x = x - 1
print(x)
