score = 0

def add(a, b=1):
    return a + b

for i in range(3):
    score = add(score, i)
    print(f'{score}')
